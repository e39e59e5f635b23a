# SPDX-License-Identifier: GPL-3.0-or-later
"""The outer faces of a grid of VTK, and some of them."""

import numpy as np


def surface_of(grid):
    """The outer faces of a grid with the numbers of their points and cells in the grid."""
    from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter

    surface = vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.PassThroughPointIdsOn()
    surface.PassThroughCellIdsOn()
    surface.Update()
    return surface.GetOutput()


def faces_of(surface):
    """(nodes, offsets) of the faces of a surface: face f has nodes[offsets[f]:offsets[f + 1]]."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    faces = surface.GetPolys()
    return (vtk_to_numpy(faces.GetConnectivityArray()), vtk_to_numpy(faces.GetOffsetsArray()))


def face_keys(surface, n_points):
    """A number for each face that two faces of one grid have in common only if they have the same nodes."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    nodes, offsets = faces_of(surface)
    numbers = vtk_to_numpy(surface.GetPointData().GetArray("vtkOriginalPointIds"))[nodes]
    sizes = np.diff(offsets)
    padded = np.full((len(sizes), sizes.max()), np.iinfo(np.int64).max)
    padded[np.arange(padded.shape[1]) < sizes[:, None]] = numbers
    padded.sort(axis=1)
    # Two faces of a valid mesh with three nodes in common are the same.
    return (padded[:, 0] * n_points + padded[:, 1]) * n_points + padded[:, 2]


def with_faces(surface, chosen):
    """A surface of the chosen faces with their colours."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    nodes, offsets = faces_of(surface)
    sizes = np.diff(offsets)
    faces = vtkCellArray()
    faces.SetData(
        numpy_to_vtkIdTypeArray(np.concatenate(([0], np.cumsum(sizes[chosen]))).astype(np.int64),
                                deep=True),
        numpy_to_vtkIdTypeArray(nodes[np.repeat(chosen, sizes)].astype(np.int64), deep=True))
    part = vtkPolyData()
    part.SetPoints(surface.GetPoints())
    part.SetPolys(faces)
    colours = vtk_to_numpy(surface.GetCellData().GetScalars())[chosen]
    part.GetCellData().SetScalars(numpy_to_vtk(np.ascontiguousarray(colours), deep=True))
    return part
