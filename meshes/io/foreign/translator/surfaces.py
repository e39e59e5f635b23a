# SPDX-License-Identifier: GPL-3.0-or-later
"""STL, OBJ and PLY, read by VTK and written by VTK or meshio."""

from pathlib import Path

import numpy as np

from .mesh import Failure, grid_of, mesh_of, without_fields
from .meshio_library import write_by_meshio


def read_surface(path):
    from vtkmodules.vtkFiltersCore import vtkAppendFilter, vtkCleanPolyData
    if path.lower().endswith(".stl"):
        from vtkmodules.vtkIOGeometry import vtkSTLReader as Reader
    elif path.lower().endswith(".obj"):
        from vtkmodules.vtkIOGeometry import vtkOBJReader as Reader
    else:
        from vtkmodules.vtkIOPLY import vtkPLYReader as Reader
    reader = Reader()
    reader.SetFileName(path)
    reader.Update()
    clean, append = vtkCleanPolyData(), vtkAppendFilter()
    clean.SetInputConnection(reader.GetOutputPort())
    clean.SetTolerance(0.0)
    append.SetInputConnection(clean.GetOutputPort())
    append.Update()
    if not append.GetOutput().GetNumberOfCells():
        raise Failure("the file has no faces; it is damaged or of another format")
    mesh = mesh_of(append.GetOutput())
    if "GroupIds" in mesh.cell_data and np.ptp(mesh.cell_data["GroupIds"]) == 0:
        del mesh.cell_data["GroupIds"]  # of VTK, for OBJ files without groups
    return mesh


def write_stl(mesh, path):
    from vtkmodules.vtkFiltersCore import vtkAppendFilter, vtkTriangleFilter
    from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
    from vtkmodules.vtkIOGeometry import vtkSTLWriter
    surface, triangles, append, writer = vtkGeometryFilter(), vtkTriangleFilter(), vtkAppendFilter(), vtkSTLWriter()
    surface.SetInputData(grid_of(mesh.largest()))
    triangles.SetInputConnection(surface.GetOutputPort())
    append.SetInputConnection(triangles.GetOutputPort())
    append.Update()
    writer.SetInputConnection(triangles.GetOutputPort())
    writer.SetFileName(path)
    writer.SetFileTypeToBinary()
    if writer.Write() != 1:
        raise Failure("VTK's writer does not take the mesh")
    return without_fields(mesh_of(append.GetOutput()))


def write_surface(mesh, path):
    mesh = without_fields(mesh.largest())
    write_by_meshio(mesh, path, Path(path).suffix.lower()[1:])
    return mesh
