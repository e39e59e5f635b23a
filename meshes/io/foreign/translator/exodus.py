# SPDX-License-Identifier: GPL-3.0-or-later
"""Exodus, by VTK."""

import dataclasses
import re

import numpy as np

from .exodus_sets import Group, divided_side_sets, fields_of_cells, fields_of_nodes, with_positive_numbers
from .fields import with_joined_fields, with_split_fields
from .mesh import TAG_ARRAYS, TAGS, TYPE_NAMES, Failure, grid_of, in_other_order_of_wedges, joined, mesh_of

BLOCKS = "smoothfem_block"
INTEGERS = (*TAG_ARRAYS, "fixed", "node_id", "cell_id")
MEANINGFUL = (*INTEGERS, "BoundaryID", "boundary_id")  # names of fields that mean more to the reader of .vtu files


def read_exodus(path):
    """All blocks and side sets; their numbers are the tags, unless a field has tags that refine the blocks. Node sets, and side
    sets that cover cells of a surface, become fields."""
    blocks, side_sets, node_sets = groups_of(path)
    require_corners_only(path, blocks)
    if not blocks:
        raise Failure("the file has no cells")
    side_sets, masks = divided_side_sets(side_sets, blocks)
    points = blocks[0].mesh.point_data
    points.update(fields_of_nodes(node_sets, len(blocks[0].mesh.points), {*points, *with_initial_fields(points), *MEANINGFUL}))
    mesh = with_tags_of_groups(*([group.without_vtk_arrays() for group in groups] for groups in (blocks, side_sets)))
    mesh.cell_data.update(fields_of_cells(masks, len(mesh.types), {*mesh.cell_data, *MEANINGFUL}))
    return mesh


def groups_of(path):
    """The blocks, the side sets and the node sets that are not empty."""
    from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
    from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet
    from vtkmodules.vtkIOExodus import vtkExodusIIReader
    errors, reader = vtkStringOutputWindow(), vtkExodusIIReader()
    vtkOutputWindow.SetInstance(errors)
    reader.SetFileName(path)
    reader.UpdateInformation()
    reader.SetSqueezePoints(False)  # squeezed points have single precision
    reader.ApplyDisplacementsOff()
    kinds = {reader.ELEM_BLOCK: "Element Blocks", reader.SIDE_SET: "Side Sets", reader.NODE_SET: "Node Sets"}
    for kind in kinds:
        for i in range(reader.GetNumberOfObjects(kind)):
            reader.SetObjectStatus(kind, i, 1)
    for kind in (reader.NODAL, reader.ELEM_BLOCK):
        for i in range(reader.GetNumberOfObjectArrays(kind)):
            reader.SetObjectArrayStatus(kind, reader.GetObjectArrayName(kind, i), 1)
    reader.GenerateObjectIdCellArrayOff()
    reader.GenerateGlobalElementIdArrayOn()  # the side sets name elements by it
    reader.GenerateGlobalNodeIdArrayOff()
    n_steps = reader.GetNumberOfTimeSteps()
    if n_steps > 1:
        print(f"note: only the last of {n_steps} time steps is read")
        reader.SetTimeStep(n_steps - 1)
    reader.Update()
    refuse_unknown_types(errors.GetOutput())
    leaves, output, name_of = {}, reader.GetOutput(), lambda data, b: data.GetMetaData(b).Get(vtkCompositeDataSet.NAME())
    for b in range(output.GetNumberOfBlocks()):
        group = output.GetBlock(b)
        for k in range(group.GetNumberOfBlocks() if group else 0):
            if group.GetBlock(k) is not None:
                leaves[name_of(output, b), name_of(group, k)] = group.GetBlock(k)
    found = {kind: [] for kind in kinds}
    for kind, title in kinds.items():
        for i in range(reader.GetNumberOfObjects(kind)):
            name = reader.GetObjectName(kind, i)
            leaf = leaves.get((title, name))
            if leaf is not None and leaf.GetNumberOfCells():
                found[kind].append(Group(mesh_of(leaf), reader.GetObjectId(kind, i), "" if name.startswith("Unnamed") else name))
    return found.values()


def refuse_unknown_types(errors):
    unknown = re.search(r"Unsupported element type: (\S+)", errors)
    if unknown and unknown[1].upper().startswith("BEX"):
        raise Failure(f"the file has patches of isogeometric analysis ({unknown[1]}), not cells with straight edges; "
                      "save the mesh with linear cells")
    if unknown:
        raise Failure(f"the file has elements of the type {unknown[1]}, which VTK cannot read; save the mesh with linear cells")


def require_corners_only(path, blocks):
    """VTK takes the corners of some cells of higher order, without a word."""
    known = {int(size) for block in blocks for size in np.unique(np.diff(block.mesh.offsets))}
    is_linear = all(np.isin(block.mesh.types, (0, 1, 2, 4, 6, 8, 11, *TYPE_NAMES)).all() for block in blocks)
    sizes = [size for size in sizes_of_elements(path) if size not in known] if is_linear else [max(known)]
    if sizes:
        raise Failure(f"the file has cells with {max(sizes)} nodes; cells with nodes other than their corners cannot be read: "
                      "save the mesh with linear cells")


def sizes_of_elements(path):
    """The numbers of nodes of an element in each block, from the shapes of the arrays that list them."""
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
    from vtkmodules.vtkIONetCDF import vtkNetCDFReader
    reader, sizes = vtkNetCDFReader(), set()
    reader.SetFileName(path)
    reader.UpdateMetaData()
    names = [reader.GetVariableArrayName(i) for i in range(reader.GetNumberOfVariableArrays())]
    dimensions = [reader.GetVariableDimensions().GetValue(i) for i in range(len(names))]
    for name in names:
        reader.SetVariableArrayStatus(name, 0)
    for name, dimension in zip(names, dimensions):
        if re.fullmatch(r"connect\d+", name) and "num_nod_per_el" in dimension and "," in dimension:
            reader.SetVariableArrayStatus(name, 1)
            reader.UpdateInformation()
            extent = reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.WHOLE_EXTENT())
            sizes.add(extent[1] - extent[0] + 1)
            reader.SetVariableArrayStatus(name, 0)
    return sizes


def with_tags_of_groups(blocks, side_sets):
    def tag_in(array, mesh):
        values = mesh.cell_data.get(array, np.array([np.nan]))
        return int(values[0]) if (values == values[0]).all() and values[0] % 1 == 0 else None
    found = [array for array in TAG_ARRAYS if any(array in block.mesh.cell_data for block in blocks)]
    refining = [array for array in found if all(tag_in(array, block.mesh) is not None for block in blocks)]
    array = refining[0] if refining else TAGS
    if refining:
        blocks = [dataclasses.replace(block, number=tag_in(array, block.mesh)) for block in blocks]
    if any(block.name for block in blocks) or (len(blocks) > 1 and not refining):
        blocks = with_positive_numbers(blocks, "block", [group.number for group in blocks + side_sets])
    side_sets = with_positive_numbers(side_sets, "side set", [group.number for group in blocks + side_sets])
    names = []
    for group in blocks + side_sets:
        group.mesh.cell_data[array] = np.full(len(group.mesh.types), group.number, np.int32)
        if group.name:
            names.append((int(group.mesh.dimensions().max()), group.number, group.name))
    mesh = joined([group.mesh for group in blocks + side_sets], have_same_points=True)
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
