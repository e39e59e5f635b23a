#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""sfepy_taubin.py IN OUT ITERATIONS: sfepy's mesh smoothing (Taubin's, alternating steps with 0.6307 and -0.6347)
on a legacy VTK file. It also moves the boundary, so fixed nodes are reset at the end. Needs python3-sfepy."""

import sys
import time

import numpy as np
from sfepy.base.base import output
from sfepy.discrete.fem import Mesh
from sfepy.mesh.mesh_tools import smooth_mesh
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader, vtkUnstructuredGridWriter


def main(source, target, n_iterations):
    """Smooths the mesh and prints the time of the smoothing alone."""
    output.set_output(quiet=True)
    reader = vtkUnstructuredGridReader()
    reader.SetFileName(source)
    reader.Update()
    grid = reader.GetOutput()
    points = vtk_to_numpy(grid.GetPoints().GetData())
    fixed = vtk_to_numpy(grid.GetPointData().GetArray("fixed")).astype(bool)
    mesh = Mesh.from_file(source)
    if len(mesh.coors) != len(points):
        sys.exit(f"sfepy reads {len(mesh.coors)} of {len(points)} nodes")
    start = time.perf_counter()
    moved = smooth_mesh(mesh, n_iter=int(n_iterations))
    print(f"time {time.perf_counter() - start:.9f} s")
    points[~fixed, :moved.shape[1]] = np.asarray(moved)[~fixed]
    writer = vtkUnstructuredGridWriter()
    writer.SetFileName(target)
    writer.SetInputData(grid)
    writer.SetFileTypeToBinary()
    writer.Write()


main(*sys.argv[1:])
