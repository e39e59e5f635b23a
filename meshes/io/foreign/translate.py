#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Translates mesh files of other formats to and from .vtu, by VTK, meshio and h5py.

translate.py read FILE MESH.vtu    translate.py write MESH.vtu FILE

Lines "note: ..." of the output name the losses. If the translation fails, the last line says why, and the exit code is 1.
Each written file is read again: a library that loses cells in silence is found out."""

import contextlib
import dataclasses
import io
import re
import sys
from collections import Counter
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

EXODUS, XDMF, SURFACES = (".exo", ".e", ".ex2"), (".xdmf", ".xmf"), (".stl", ".obj", ".ply")
TAGS, NAMES, BLOCKS = "physical_tag", "physical_name", "smoothfem_block"
# Cell arrays that count as the tags, as in .vtu files: the first one that a file has.
TAG_ARRAYS = (TAGS, "gmsh:physical", "MaterialID", "material_id", "material", "attribute", "CellEntityIds", "medit:ref")
INTEGERS = (*TAG_ARRAYS, "fixed", "node_id", "cell_id")

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


def meshio():
    try:
        import meshio
    except ImportError:
        raise Failure("this format needs meshio; on Debian: apt install python3-meshio python3-h5py") from None
    return meshio


# VTK's grids

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


# Fields of several components. A format that lacks some numbers of components gets one array for each component. Its name ends
# with the number of the component, ten characters wide, as VTK does it for Exodus.

def with_split_fields(arrays, held):
    split = {}
    for name, values in arrays.items():
        if values.ndim == 1 or values.shape[1] in held:
            split[name] = values
        else:
            split.update({f"{name}{k:10d}": values[:, k] for k in range(values.shape[1])})
    return split


def with_joined_fields(arrays):
    components, result = {}, {}
    for name, values in arrays.items():
        part = re.fullmatch(r"(.+)(?=.{10}$)( +\d+)", name)
        base, k = (part[1], int(part[2])) if part else (name, None)
        components.setdefault((base, k is None), {})[k] = values
    for (base, is_whole), parts in components.items():
        if is_whole:
            result[base] = parts[None]
        elif sorted(parts) == list(range(len(parts))) and base not in arrays:
            result[base] = np.column_stack([parts[k] for k in sorted(parts)])
        else:
            result.update({f"{base}{k:10d}": values for k, values in parts.items()})
    return result


# Exodus

def read_exodus(path):
    """All element blocks and side sets; their numbers are the tags, unless a field has tags that refine the blocks."""
    from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet
    from vtkmodules.vtkIOExodus import vtkExodusIIReader
    reader = vtkExodusIIReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    reader.SetSqueezePoints(False)  # squeezed points have single precision
    reader.ApplyDisplacementsOff()
    for kind in (reader.ELEM_BLOCK, reader.SIDE_SET):
        for i in range(reader.GetNumberOfObjects(kind)):
            reader.SetObjectStatus(kind, i, 1)
    for kind in (reader.NODAL, reader.ELEM_BLOCK):
        for i in range(reader.GetNumberOfObjectArrays(kind)):
            reader.SetObjectArrayStatus(kind, reader.GetObjectArrayName(kind, i), 1)
    reader.GenerateObjectIdCellArrayOff()
    reader.GenerateGlobalElementIdArrayOff()
    reader.GenerateGlobalNodeIdArrayOff()
    n_steps = reader.GetNumberOfTimeSteps()
    if n_steps > 1:
        print(f"note: only the last of {n_steps} time steps is read")
        reader.SetTimeStep(n_steps - 1)
    reader.Update()
    leaves, output = {}, reader.GetOutput()
    for b in range(output.GetNumberOfBlocks()):
        group = output.GetBlock(b)
        for k in range(group.GetNumberOfBlocks() if group else 0):
            if group.GetBlock(k) is not None:
                leaves[group.GetMetaData(k).Get(vtkCompositeDataSet.NAME())] = group.GetBlock(k)
    blocks = []
    for kind in (reader.ELEM_BLOCK, reader.SIDE_SET):
        for i in range(reader.GetNumberOfObjects(kind)):
            name = reader.GetObjectName(kind, i)
            if name in leaves and leaves[name].GetNumberOfCells():
                blocks.append((mesh_of(leaves[name]), reader.GetObjectId(kind, i), name, kind == reader.ELEM_BLOCK))
    return with_tags_of_blocks(blocks)


def with_tags_of_blocks(blocks):
    def tag_in(array, mesh):
        values = mesh.cell_data.get(array, np.array([np.nan]))
        return int(values[0]) if (values == values[0]).all() and values[0] % 1 == 0 else None
    found = [array for array in TAG_ARRAYS if any(array in mesh.cell_data for mesh, *_ in blocks)]
    refining = [array for array in found if all(tag_in(array, mesh) is not None for mesh, _, _, is_block in blocks if is_block)]
    array, names = refining[0] if refining else TAGS, []
    for mesh, number, name, is_block in blocks:
        tag = tag_in(array, mesh) if refining and is_block else number
        mesh.cell_data[array] = np.full(len(mesh.types), tag, np.int32)
        if not name.startswith("Unnamed"):
            names.append((int(mesh.dimensions().max()), tag, name))
    mesh = joined([block[0] for block in blocks], have_same_points=True)
    if mesh.tags() is None:
        mesh.cell_data.pop(array)
    return dataclasses.replace(mesh, point_data=with_initial_fields(mesh.point_data),
                               cell_data=with_initial_fields(mesh.cell_data), names=names)


def with_initial_fields(arrays):
    """Exodus has numbers of one type, with one component. VTK makes "v_" of "v_X", "v_Y" and "v_Z"."""
    result = {}
    for name, values in with_joined_fields(arrays).items():
        is_vector = values.ndim == 2 and name.endswith("_") and name[:-1] not in arrays
        is_integer = name in INTEGERS and not (values % 1).any()
        result[name[:-1] if is_vector else name] = values.astype(np.int64) if is_integer else values
    return result


def write_exodus(mesh, path):
    """One block for each tag and type of cells. Its number is the tag if it can be; the tags are written as a field, too."""
    from vtkmodules.vtkIOExodus import vtkExodusIIWriter
    mesh = mesh.largest()
    tags = mesh.tags()
    if tags is None:
        tags = np.zeros(len(mesh.types), int)
        mesh.cell_data[TAGS] = tags
    numbers, n_free = {}, max(0, tags.max()) + 1
    for tag, cell_type in sorted(set(zip(tags.tolist(), mesh.types.tolist()))):
        is_taken = tag <= 0 or tag in numbers.values()
        numbers[tag, cell_type] = n_free if is_taken else tag
        n_free += is_taken
    blocks = np.array([numbers[pair] for pair in zip(tags.tolist(), mesh.types.tolist())], np.int32)
    # VTK leaves out nodal fields named disp..., without a word; its reader removes the blank.
    point_data = {" " * name.lower().startswith("disp") + name: values for name, values in mesh.point_data.items()}
    written = dataclasses.replace(in_other_order_of_wedges(mesh), point_data=with_split_fields(point_data, {1, 3}),
                                  cell_data={**with_split_fields(mesh.cell_data, {1, 3}), BLOCKS: blocks})
    writer = vtkExodusIIWriter()
    writer.SetFileName(path)
    writer.SetInputData(grid_of(written))  # one grid: blocks of several would not share nodes
    writer.SetBlockIdArrayName(BLOCKS)
    writer.SetStoreDoubles(1)
    writer.WriteOutBlockIdArrayOff()
    writer.WriteOutGlobalElementIdArrayOff()
    writer.WriteOutGlobalNodeIdArrayOff()
    writer.Write()
    return mesh


def in_other_order_of_wedges(mesh):
    """The first triangle of VTK's wedges looks outwards, that of Exodus and CGNS inwards."""
    starts = mesh.offsets[:-1][mesh.types == WEDGE]
    nodes = mesh.nodes.copy()
    for k in (1, 4):
        nodes[starts + k], nodes[starts + k + 1] = mesh.nodes[starts + k + 1], mesh.nodes[starts + k]
    return dataclasses.replace(mesh, nodes=nodes)


# CGNS

def read_cgns(path):
    from vtkmodules.vtkIOCGNSReader import vtkCGNSReader
    reader = vtkCGNSReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    reader.EnableAllBases()
    reader.EnableAllFamilies()
    reader.Update()
    return joined([mesh_of(leaf) for leaf in leaves_of(reader.GetOutput())])


def leaves_of(data):
    if data is None:
        return []
    if hasattr(data, "GetNumberOfBlocks"):
        return [leaf for b in range(data.GetNumberOfBlocks()) for leaf in leaves_of(data.GetBlock(b))]
    if data.IsA("vtkStructuredGrid"):
        raise Failure("the file has a structured grid; save it with unstructured cells")
    return [data] if data.GetNumberOfCells() else []


def write_cgns(mesh, path):
    """A file of CGNS/HDF5: one zone with one section for each type of cells."""
    try:
        import h5py
    except ImportError:
        raise Failure("CGNS files are written by h5py; on Debian: apt install python3-h5py") from None
    mesh = mesh.largest()

    def describe(group, name, label, data):
        kind = "MT" if data is None else {"i1": "C1", "i4": "I4", "f4": "R4", "f8": "R8"}[data.dtype.str[1:]]
        for key, text, size in (("name", name, 33), ("label", label, 33), ("type", kind, 3)):
            group.attrs.create(key, np.bytes_(text), dtype=h5py.string_dtype("ascii", size))
        group.attrs.create("flags", np.array([1], np.int32))
        if data is not None:
            group.create_dataset(" data", data=data)

    def add(parent, name, label, data=None):
        group = parent.create_group(name, track_order=True)
        describe(group, name, label, data)
        return group

    def text(words, size=0):
        return np.frombuffer(words.encode().ljust(size, b"\0"), np.int8)

    def ints(*values):
        return np.array(values, np.int32)

    ordered = in_other_order_of_wedges(mesh)
    with h5py.File(path, "w", track_order=True, libver=("earliest", "v108")) as file:
        describe(file, "HDF5 MotherNode", "Root Node of HDF5 File", None)
        file.create_dataset(" format", data=text(f"IEEE_{sys.byteorder.upper()}_32", 15))
        file.create_dataset(" hdf5version", data=text("HDF5 Version 1.8", 33))
        add(file, "CGNSLibraryVersion", "CGNSLibraryVersion_t", np.array([3.2], np.float32))
        base = add(file, "Base", "CGNSBase_t", ints(int(mesh.dimensions().max()), 3))
        zone = add(base, "Zone", "Zone_t", ints([len(mesh.points)], [len(mesh.types)], [0]))
        add(zone, "ZoneType", "ZoneType_t", text("Unstructured"))
        coordinates = add(zone, "GridCoordinates", "GridCoordinates_t")
        for k, axis in enumerate("XYZ"):
            add(coordinates, "Coordinate" + axis, "DataArray_t", mesh.points[:, k].astype(np.float64))
        n = 0
        for cell_type, number in ((5, 5), (9, 7), (10, 10), (14, 12), (13, 14), (12, 17)):  # VTK's and CGNS's numbers
            part = ordered.only(mesh.types == cell_type)
            if len(part.types):
                section = add(zone, TYPE_NAMES[cell_type].capitalize(), "Elements_t", ints(number, 0))
                add(section, "ElementRange", "IndexRange_t", ints(n + 1, n + len(part.types)))
                add(section, "ElementConnectivity", "DataArray_t", (part.nodes + 1).astype(np.int32))
                n += len(part.types)
    return without_fields(mesh)


def without_fields(mesh):
    return dataclasses.replace(mesh, point_data={}, cell_data={})


# XDMF

def read_xdmf(path):
    from tempfile import TemporaryDirectory
    mesh = meshio().read(path, file_format="xdmf")
    with TemporaryDirectory() as folder:
        translated = str(Path(folder) / "mesh.vtu")
        mesh.write(translated, file_format="vtu", compression=None)
        mesh = load_vtu(translated)
    return dataclasses.replace(mesh, point_data=with_joined_fields(mesh.point_data), cell_data=with_joined_fields(mesh.cell_data))


def write_xdmf(mesh, path):
    mesh = mesh.only(mesh.types != VERTEX)  # meshio cannot read them back
    held = {1, 2, 3, 6, 9}
    write_by_meshio(dataclasses.replace(mesh, point_data=as_wide_numbers(with_split_fields(mesh.point_data, held)),
                                        cell_data=as_wide_numbers(with_split_fields(mesh.cell_data, held))),
                    path, "xdmf", data_format="XML")
    return mesh


def as_wide_numbers(arrays):
    """meshio writes no integers of 8 or 16 bits."""
    return {name: values.astype(np.int32) if values.dtype.itemsize < 4 else values for name, values in arrays.items()}


def write_by_meshio(mesh, path, file_format, **options):
    library = meshio()
    names = {3: "line", 5: "triangle", 9: "quad", 10: "tetra", 12: "hexahedron", 13: "wedge", 14: "pyramid"}
    starts = np.concatenate([[0], np.flatnonzero(np.diff(mesh.types)) + 1, [len(mesh.types)]])
    blocks = [(names[mesh.types[a]], mesh.nodes[mesh.offsets[a]:mesh.offsets[b]].reshape(b - a, -1))
              for a, b in zip(starts[:-1], starts[1:])]
    cell_data = {name: np.split(values, starts[1:-1]) for name, values in mesh.cell_data.items()}
    library.write(path, library.Mesh(mesh.points, blocks, mesh.point_data, cell_data), file_format=file_format, **options)


# Surfaces

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


# All formats

def reader_of(suffix):
    return read_exodus if suffix in EXODUS else read_xdmf if suffix in XDMF else read_cgns if suffix == ".cgns" else read_surface


def read(source, target):
    save_vtu(reader_of(Path(source).suffix.lower())(source), target)


def write(source, target):
    suffix = Path(target).suffix.lower()
    writer = (write_exodus if suffix in EXODUS else write_xdmf if suffix in XDMF else write_cgns if suffix == ".cgns"
              else write_stl if suffix == ".stl" else write_surface)
    meant = writer(load_vtu(source), target)
    if not Path(target).exists():
        raise Failure("the library for this format has written no file")
    library = {write_cgns: "h5py", write_xdmf: "meshio", write_surface: "meshio"}.get(writer, "VTK")
    try:
        read_back = reader_of(suffix)(target)
    except Exception as error:
        raise Failure(f"{library} has written a file that cannot be read ({described(error)}); choose .vtu") from None
    difference = differs(meant, read_back, suffix in SURFACES)
    if difference:
        raise Failure(f"this mesh cannot be written by {library}: read back, {difference}; choose .vtu")


def differs(meant, found, has_single_precision):
    """Says how a mesh that was read back differs from the one that was written; nothing if it does not."""
    def kinds(mesh):
        tags = mesh.tags() if meant.cell_data else None
        return Counter(zip(mesh.types.tolist(), [0] * len(mesh.types) if tags is None else tags.tolist()))

    def nodes(mesh):
        used = mesh.points[np.unique(mesh.nodes)]
        return np.unique(used.astype(np.float32) + 0, axis=0) if has_single_precision else used
    n_wrong = max((kinds(meant) - kinds(found)).total(), (kinds(found) - kinds(meant)).total())
    if n_wrong:
        return f"{n_wrong} of {len(meant.types)} cells differ"
    if len(nodes(meant)) != len(nodes(found)):
        return f"it has {len(nodes(found))} nodes instead of {len(nodes(meant))}"
    for cell_type in np.unique(meant.types):  # the order of cells may differ, so coordinates are sorted
        a, b = (np.sort(mesh.points[mesh.only(mesh.types == cell_type).nodes], axis=0) for mesh in (meant, found))
        if not np.allclose(a, b, rtol=0, atol=1e-6 * np.abs(meant.points).max()):
            return f"the nodes of {TYPE_NAMES[int(cell_type)]} differ"
    for a, b in ((meant.point_data, found.point_data), (meant.cell_data, found.cell_data)):
        for name, values in a.items():
            is_part = values.ndim == 1 and name[:-1] in b  # VTK joins the fields vX, vY and vZ of Exodus files to v
            if values.any() and not is_part and (name not in b or b[name].shape[1:] != values.shape[1:]):
                return f"the field '{name}' is missing"
    return None


def described(error):
    """An error of a library in words."""
    text = (str(error).splitlines() or [""])[0]
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def main(direction, source, target):
    errors = io.StringIO()
    try:
        with contextlib.redirect_stderr(errors):
            {"read": read, "write": write}[direction](source, target)
    except Failure as failure:
        print(failure)
        return 1
    except (Exception, SystemExit) as error:  # of a library, about a file that it does not understand
        print(f"the file cannot be translated ({described(error)}); save it in another format, for example .vtu")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
