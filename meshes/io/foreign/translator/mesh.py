# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh between all formats, and VTK's grids that hold it."""

import dataclasses

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

TAGS, NAMES = "physical_tag", "physical_name"
# Cell arrays that count as the tags, as in .vtu files: the first one that a file has.
TAG_ARRAYS = (TAGS, "gmsh:physical", "MaterialID", "material_id", "material", "attribute", "CellEntityIds", "medit:ref")

VERTEX, WEDGE = 1, 13
DIMENSIONS = {1: 0, 2: 0, 3: 1, 4: 1, 10: 3, 11: 3, 12: 3, 13: 3, 14: 3}  # of VTK's types of cells; all others: 2
TYPE_NAMES = {3: "lines", 5: "triangles", 7: "polygons", 9: "quadrilaterals", 10: "tetrahedra", 12: "hexahedra", 13: "prisms",
              14: "pyramids"}


class Failure(Exception):
    """A sentence for the user."""


@dataclasses.dataclass
class Mesh:
    points: np.ndarray
    types: np.ndarray  # of the cells, VTK's numbers
    offsets: np.ndarray  # cell c has the nodes nodes[offsets[c]:offsets[c + 1]]
    nodes: np.ndarray
    point_data: dict
    cell_data: dict
    names: list = dataclasses.field(default_factory=list)  # of groups: dimension, tag, name

    def dimensions(self):
        return np.array([DIMENSIONS.get(t, 2) for t in range(256)])[self.types]

    def only(self, chosen):
        """The chosen cells (a mask) and all points."""
        sizes = np.diff(self.offsets)
        return dataclasses.replace(self, types=self.types[chosen], offsets=ends(sizes[chosen]),
                                   nodes=self.nodes[np.repeat(chosen, sizes)],
                                   cell_data={name: values[chosen] for name, values in self.cell_data.items()})

    def largest(self):
        """The cells of the highest dimension."""
        return self.only(self.dimensions() == self.dimensions().max())

    def tags(self):
        """The tags of the cells, or None if no cell has one."""
        array = next((self.cell_data[name] for name in TAG_ARRAYS if name in self.cell_data), None)
        return None if array is None or array.ndim != 1 or not array.any() else np.nan_to_num(array).astype(int)


def ends(sizes):
    return np.concatenate([[0], np.cumsum(sizes, dtype=np.int64)])


def without_fields(mesh):
    return dataclasses.replace(mesh, point_data={}, cell_data={})


def in_other_order_of_wedges(mesh):
    """The first triangle of VTK's wedges looks outwards, that of Exodus and CGNS inwards."""
    starts = mesh.offsets[:-1][mesh.types == WEDGE]
    nodes = mesh.nodes.copy()
    for k in (1, 4):
        nodes[starts + k], nodes[starts + k + 1] = mesh.nodes[starts + k + 1], mesh.nodes[starts + k]
    return dataclasses.replace(mesh, nodes=nodes)


def arrays_of(data):
    arrays = [data.GetArray(i) for i in range(data.GetNumberOfArrays())]
    return {array.GetName(): vtk_to_numpy(array) for array in arrays if array is not None and array.GetName()}


def mesh_of(grid):
    return Mesh(vtk_to_numpy(grid.GetPoints().GetData()), vtk_to_numpy(grid.GetCellTypesArray()),
                vtk_to_numpy(grid.GetCells().GetOffsetsArray()), vtk_to_numpy(grid.GetCells().GetConnectivityArray()),
                arrays_of(grid.GetPointData()), arrays_of(grid.GetCellData()))


def grid_of(mesh):
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid
    grid, points, cells = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(mesh.points), deep=True))
    cells.SetData(numpy_to_vtkIdTypeArray(mesh.offsets.astype(np.int64), deep=True),
                  numpy_to_vtkIdTypeArray(mesh.nodes.astype(np.int64), deep=True))
    grid.SetPoints(points)
    grid.SetCells(numpy_to_vtk(mesh.types.astype(np.uint8), deep=True), cells)
    for data, arrays in ((grid.GetPointData(), mesh.point_data), (grid.GetCellData(), mesh.cell_data)):
        for name, values in arrays.items():
            array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
            array.SetName(name)
            data.AddArray(array)
    return grid


def joined(meshes, have_same_points=False):
    """One mesh of several, without nodes of no cell. Nodes of different meshes at the same place become one, unless the meshes
    share all points."""
    if not meshes:
        raise Failure("the file has no cells")
    have_same_points = have_same_points or len(meshes) == 1
    with_points = meshes[:1] if have_same_points else meshes
    points = np.concatenate([mesh.points for mesh in with_points])
    starts = np.zeros(len(meshes), int) if have_same_points else ends([len(mesh.points) for mesh in meshes])
    nodes = np.concatenate([mesh.nodes + start for mesh, start in zip(meshes, starts)])
    if not have_same_points:
        _, first, place = np.unique(points + 0.0, axis=0, return_index=True, return_inverse=True)  # -0 + 0 is 0
        nodes = first[place.ravel()][nodes]
    used, nodes = np.unique(nodes, return_inverse=True)
    return Mesh(points[used], np.concatenate([mesh.types for mesh in meshes]),
                ends(np.concatenate([np.diff(mesh.offsets) for mesh in meshes])), nodes,
                {name: values[used] for name, values in chained(with_points, "point_data").items()}, chained(meshes, "cell_data"))


def chained(meshes, kind):
    """The arrays of all meshes one after another, with NaN for a mesh that lacks one."""
    shapes = {name: values.shape[1:] for mesh in meshes for name, values in getattr(mesh, kind).items()}
    sizes = [len(mesh.points if kind == "point_data" else mesh.types) for mesh in meshes]
    return {name: np.concatenate([getattr(mesh, kind).get(name, np.full((size, *shape), np.nan))
                                  for mesh, size in zip(meshes, sizes)]) for name, shape in shapes.items()}


def save_vtu(mesh, path):
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter
    grid = grid_of(mesh)
    if mesh.names:
        lines = "".join(f"{dimension} {tag} {name}\n" for dimension, tag, name in mesh.names)
        array = numpy_to_vtk(np.frombuffer(lines.encode(), np.uint8), deep=True)
        array.SetName(NAMES)
        grid.GetFieldData().AddArray(array)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(path)
    writer.SetInputData(grid)
    if writer.Write() != 1:
        raise Failure("the translated mesh cannot be written; the disk may be full")


def load_vtu(path):
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    return mesh_of(reader.GetOutput())
