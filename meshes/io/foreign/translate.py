#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Translates mesh files of other formats to and from .vtu, by VTK and meshio.

translate.py read FILE MESH.vtu    translate.py write MESH.vtu FILE

Lines "note: ..." of the output name the losses. If the translation fails, the last line says why, and the exit code is 1."""

import contextlib
import io
import sys
from pathlib import Path

EXODUS, SURFACES = (".exo", ".e", ".ex2"), (".stl", ".obj", ".ply")
TAGS, NAMES, BLOCKS = "physical_tag", "physical_name", "ObjectId"


class Failure(Exception):
    """A sentence for the user."""


def meshio():
    try:
        import meshio
    except ImportError:
        raise Failure("this format needs meshio; on Debian: apt install python3-meshio python3-h5py") from None
    return meshio


def read_exodus(path):
    """All element blocks and side sets; their numbers are the tags."""
    from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet
    from vtkmodules.vtkIOExodus import vtkExodusIIReader
    reader = vtkExodusIIReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
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
    grids, names = [], []
    leaves = {}
    output = reader.GetOutput()
    for b in range(output.GetNumberOfBlocks()):
        group = output.GetBlock(b)
        for k in range(group.GetNumberOfBlocks() if group else 0):
            if group.GetBlock(k) is not None:
                leaves[group.GetMetaData(k).Get(vtkCompositeDataSet.NAME())] = group.GetBlock(k)
    for kind in (reader.ELEM_BLOCK, reader.SIDE_SET):
        for i in range(reader.GetNumberOfObjects(kind)):
            number, name = reader.GetObjectId(kind, i), reader.GetObjectName(kind, i)
            leaf = leaves.get(name)
            if leaf is None or not leaf.GetNumberOfCells():
                continue
            grids.append((leaf, number))
            if not name.startswith("Unnamed"):
                names.append((dimension(leaf), number, name))
    return merged(grids), names


def read_cgns(path):
    from vtkmodules.vtkIOCGNSReader import vtkCGNSReader
    reader = vtkCGNSReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    reader.EnableAllBases()
    reader.EnableAllFamilies()
    reader.Update()
    return merged([(leaf, None) for leaf in leaves_of(reader.GetOutput())]), []


def leaves_of(data):
    if data is None:
        return []
    if hasattr(data, "GetNumberOfBlocks"):
        return [leaf for b in range(data.GetNumberOfBlocks()) for leaf in leaves_of(data.GetBlock(b))]
    if data.IsA("vtkStructuredGrid"):
        raise Failure("the file has a structured grid; save it with unstructured cells")
    return [data] if data.GetNumberOfCells() else []


def dimension(grid):
    return max(grid.GetCell(c).GetCellDimension() for c in range(grid.GetNumberOfCells()))


def merged(grids):
    """One grid of several; nodes at the same place of different ones are joined. The tag of each is its number."""
    from vtkmodules.vtkCommonCore import vtkIntArray
    from vtkmodules.vtkFiltersCore import vtkAppendFilter
    append = vtkAppendFilter()
    append.MergePointsOn()
    append.ToleranceIsAbsoluteOn()
    append.SetTolerance(0.0)
    for grid, number in grids:
        copy = grid.NewInstance()
        copy.ShallowCopy(grid)
        if number is not None:
            tags = vtkIntArray()
            tags.SetName(TAGS)
            tags.SetNumberOfTuples(grid.GetNumberOfCells())
            tags.Fill(number)
            copy.GetCellData().AddArray(tags)
        append.AddInputData(copy)
    if not grids:
        raise Failure("the file has no cells")
    append.Update()
    return append.GetOutput()


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
    return append.GetOutput(), []


def save_vtu(grid, names, path):
    from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter
    if names:
        array = vtkUnsignedCharArray()
        array.SetName(NAMES)
        for byte in "".join(f"{dim} {tag} {name}\n" for dim, tag, name in names).encode():
            array.InsertNextValue(byte)
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
    return reader.GetOutput()


def read(source, target):
    suffix = Path(source).suffix.lower()
    if suffix in (".xdmf", ".xmf"):
        mesh = meshio().read(source, file_format="xdmf")
        mesh.write(target, file_format="vtu", compression=None)
        return
    reader = read_exodus if suffix in EXODUS else read_cgns if suffix == ".cgns" else read_surface
    grid, names = reader(source)
    save_vtu(grid, names, target)


def write_exodus(source, target):
    from vtkmodules.vtkIOExodus import vtkExodusIIWriter
    from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet
    from vtkmodules.vtkFiltersExtraction import vtkExtractCells
    from vtkmodules.vtkCommonCore import vtkIdList, vtkIntArray
    grid = load_vtu(source)
    largest = dimension(grid)
    tags = grid.GetCellData().GetArray(TAGS)
    groups = {}
    for c in range(grid.GetNumberOfCells()):
        if grid.GetCell(c).GetCellDimension() == largest:
            groups.setdefault((int(tags.GetValue(c)) if tags else 0, grid.GetCellType(c)), []).append(c)
    blocks = vtkMultiBlockDataSet()
    for b, ((tag, _), cells) in enumerate(sorted(groups.items())):
        ids, extract = vtkIdList(), vtkExtractCells()
        for c in cells:
            ids.InsertNextId(c)
        extract.SetInputData(grid)
        extract.SetCellList(ids)
        extract.Update()
        block, numbers = extract.GetOutput(), vtkIntArray()
        numbers.SetName(BLOCKS)
        numbers.SetNumberOfTuples(block.GetNumberOfCells())
        numbers.Fill(tag)
        block.GetCellData().AddArray(numbers)
        blocks.SetBlock(b, block)
    writer = vtkExodusIIWriter()
    writer.SetFileName(target)
    writer.SetInputData(blocks)
    writer.SetBlockIdArrayName(BLOCKS)
    writer.WriteOutBlockIdArrayOff()
    writer.WriteOutGlobalElementIdArrayOff()
    writer.WriteOutGlobalNodeIdArrayOff()
    writer.Write()


def write_by_meshio(source, target, file_format, **options):
    library = meshio()
    mesh = library.read(source)
    if file_format in ("obj", "ply", "cgns"):
        kept = [block for block in mesh.cells if block.dim == max(b.dim for b in mesh.cells)]
        mesh = library.Mesh(mesh.points, [(block.type, block.data) for block in kept])
    library.write(target, mesh, file_format=file_format, **options)


def write_stl(source, target):
    from vtkmodules.vtkFiltersCore import vtkTriangleFilter
    from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
    from vtkmodules.vtkIOGeometry import vtkSTLWriter
    surface, triangles, writer = vtkGeometryFilter(), vtkTriangleFilter(), vtkSTLWriter()
    surface.SetInputData(load_vtu(source))
    triangles.SetInputConnection(surface.GetOutputPort())
    triangles.PassLinesOff()
    triangles.PassVertsOff()
    writer.SetInputConnection(triangles.GetOutputPort())
    writer.SetFileName(target)
    writer.SetFileTypeToBinary()
    if writer.Write() != 1:
        raise Failure("VTK's writer does not take the mesh")


def write(source, target):
    suffix = Path(target).suffix.lower()
    if suffix in EXODUS:
        write_exodus(source, target)
    elif suffix == ".stl":
        write_stl(source, target)
    elif suffix in (".xdmf", ".xmf"):
        write_by_meshio(source, target, "xdmf", data_format="XML")
    else:
        write_by_meshio(source, target, suffix[1:])
    if not Path(target).exists():
        raise Failure("the library for this format has written no file")


def main(direction, source, target):
    errors = io.StringIO()
    try:
        with contextlib.redirect_stderr(errors):
            {"read": read, "write": write}[direction](source, target)
    except Failure as failure:
        print(failure)
        return 1
    except (Exception, SystemExit) as error:  # of a library, about a file that it does not understand
        print(f"the file cannot be translated: {str(error) or type(error).__name__}".splitlines()[0])
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
