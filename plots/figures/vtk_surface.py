# SPDX-License-Identifier: GPL-3.0-or-later
"""The outer faces of a grid of VTK, some of them, and pieces of curved faces as a surface."""

import numpy as np

from .curved_faces import distinct_edges


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


def curved_surface(faces, points, n, cell_colours=None, values=None):
    """Curved faces as a surface of flat triangles with the normals of the faces and, if given, the colours of their cells or
    values at the points. faces: a list of Faces; n: pieces along each edge."""
    from vtkmodules.util.numpy_support import numpy_to_vtk

    triangles = [part.triangles(n) for part in faces]
    surface = poly_data(faces, points, n, triangles)
    data = surface.GetPointData()
    data.SetNormals(numpy_to_vtk(joined([part.normals(points, n).reshape(-1, 3) for part in faces]), deep=True))
    if values is not None:
        data.SetScalars(numpy_to_vtk(joined([part.interpolated(values, n).ravel() for part in faces]), deep=True))
    if cell_colours is not None:
        surface.GetCellData().SetScalars(numpy_to_vtk(joined(
            [np.repeat(cell_colours[part.cells], rows.shape[1], axis=0) for part, rows in zip(faces, triangles)]), deep=True))
    return surface


def curved_edges(faces, points, n):
    """The edges of curved faces as lines, each once."""
    return poly_data(faces, points, n, [part.lines(n)[chosen][:, None] for part, chosen in zip(faces, distinct_edges(faces))], True)


def poly_data(faces, points, n, rows, are_lines=False):
    """VTK's form of triangles or lines (faces, ..., nodes of each) of the points of faces."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    places = [part.interpolated(points, n).reshape(-1, 3) for part in faces]
    firsts = np.cumsum([0] + [len(part) for part in places])
    numbers = [(first + part).reshape(-1, part.shape[-1]) for first, part in zip(firsts, rows)]
    cells = vtkCellArray()
    sizes = np.concatenate([[0], *(np.full(len(part), part.shape[1]) for part in numbers)])
    cells.SetData(numpy_to_vtkIdTypeArray(np.cumsum(sizes), deep=True),
                  numpy_to_vtkIdTypeArray(joined([part.ravel() for part in numbers]), deep=True))
    result = vtkPolyData()
    vtk_points = vtkPoints()
    vtk_points.SetData(numpy_to_vtk(joined(places), deep=True))
    result.SetPoints(vtk_points)
    (result.SetLines if are_lines else result.SetPolys)(cells)
    return result


def joined(arrays):
    """One array of several, as VTK takes it."""
    return np.ascontiguousarray(np.concatenate(arrays))
