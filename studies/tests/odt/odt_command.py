#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""odt_command.py IN OUT ITERATIONS: optimal Delaunay triangulation of a mesh of triangles or tetrahedra."""

import sys

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader, vtkUnstructuredGridWriter

reader = vtkUnstructuredGridReader()
reader.SetFileName(sys.argv[1])
reader.Update()
grid = reader.GetOutput()
points = vtk_to_numpy(grid.GetPoints().GetData())
free = vtk_to_numpy(grid.GetPointData().GetArray("fixed")) == 0
n_corners = grid.GetCell(0).GetNumberOfPoints()
cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, n_corners)
for _ in range(int(sys.argv[3])):
    x = points[:, :n_corners - 1]
    edges = x[cells[:, 1:]] - x[cells[:, :1]]
    volumes = np.linalg.det(edges)
    centres = x[cells[:, 0]] + np.linalg.solve(edges, 0.5 * (edges**2).sum(axis=2)[..., None])[..., 0]
    weights = np.bincount(cells.ravel(), np.repeat(volumes, n_corners))
    for d in range(n_corners - 1):
        moments = np.bincount(cells.ravel(), np.repeat(volumes * centres[:, d], n_corners))
        points[free, d] = (moments / weights)[free]
writer = vtkUnstructuredGridWriter()
writer.SetFileName(sys.argv[2])
writer.SetInputData(grid)
writer.SetFileTypeToBinary()
writer.Write()
