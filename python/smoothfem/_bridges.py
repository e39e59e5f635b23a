# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of meshio and PyVista to meshes of smoothfem, and back. Both are imported only where one of their objects is made."""

import warnings

import numpy as np

from . import _core

# Names of meshio and VTK's numbers of cell types.
_TYPES = {"vertex": 1, "line": 3, "triangle": 5, "polygon": 7, "quad": 9, "tetra": 10, "hexahedron": 12, "wedge": 13, "pyramid": 14}
_TYPES |= {name: number for name, number, *_ in _core.second_order_types() if number}
_NAMES = {number: name for name, number in _TYPES.items()}
# meshio writes .msh files with the groups of this array.
_GMSH_TAGS, _OWN_TAGS = "gmsh:physical", "physical_tag"


def from_meshio(mesh, *, tag_field=""):
    """Makes a Mesh of a meshio.Mesh: its cells, tags of cells and of facets, names of groups, point and cell data.

    tag_field: name of the cell data with the tags (default: the first known one, such as "gmsh:physical"). What a Mesh cannot hold, for
    example sets, is left out with a UserWarning. Raises InputError for cells of an order above 2, and as Mesh does.
    """
    rows = [np.asarray(block.data) if isinstance(block.data, np.ndarray) else list(block.data) for block in mesh.cells]
    types = [_type(block.type) for block in mesh.cells]
    lengths = np.array([len(row) for block in rows for row in block], dtype=np.int64)
    nodes = np.concatenate([np.concatenate([np.asarray(row) for row in block]) for block in rows if len(block)] or [np.empty(0, np.int64)])
    cell_data = {name: np.concatenate([np.asarray(part) for part in parts]) for name, parts in mesh.cell_data.items()}
    names = {(int(entry[1]), int(entry[0])): name for name, entry in getattr(mesh, "field_data", {}).items() if len(np.atleast_1d(entry)) == 2}
    lost = [what for what in ("point_sets", "cell_sets", "gmsh_periodic") if getattr(mesh, what, None)]
    return _mesh("meshio", np.asarray(mesh.points, dtype=float), lengths, nodes, np.repeat(types, [len(block) for block in rows]),
                 dict(mesh.point_data), cell_data, names, tag_field, lost)


def to_meshio(mesh):
    """Makes a meshio.Mesh with all cells, labelled facets, tags ("gmsh:physical"), names of groups, and data of a Mesh.

    Raises InputError for a type of cells that the installed meshio does not know.
    """
    import meshio
    grid = _core.to_grid(mesh, False)
    blocks, order = [], []
    for number, n_nodes in _kinds(grid):
        chosen = np.flatnonzero((grid["types"] == number) & (np.diff(grid["offsets"]) == n_nodes))
        blocks.append((_NAMES[number], grid["nodes"][grid["offsets"][chosen][:, None] + np.arange(n_nodes)]))
        order.append(chosen)
    cell_data = {(_GMSH_TAGS if name == grid["tag_field"] == _OWN_TAGS else name): [values[chosen] for chosen in order]
                 for name, values in grid["cell_data"].items()}
    try:
        return meshio.Mesh(grid["points"], blocks, point_data=grid["point_data"], cell_data=cell_data,
                           field_data={name: np.array([tag, dim]) for (dim, tag), name in mesh.names.items()})
    except KeyError as unknown:
        raise _core.InputError(f"meshio {meshio.__version__} knows no cells of the type {unknown}; write the mesh to a file instead") from unknown


def from_pyvista(grid, *, tag_field=""):
    """Makes a Mesh of a PyVista grid or surface: its cells, tags, point and cell data.

    tag_field: as in from_meshio(). Raises InputError for cells of an order above 2, and as Mesh does.
    """
    if hasattr(grid, "cast_to_unstructured_grid"):
        grid = grid.cast_to_unstructured_grid()
    offsets = np.asarray(grid.offset, dtype=np.int64)
    lines = grid.field_data["physical_name"] if "physical_name" in grid.field_data else ()
    names = {}
    for line in bytes(bytearray(lines)).decode(errors="replace").splitlines():
        dim, tag, name = line.split(" ", 2)
        names[int(dim), int(tag)] = name
    return _mesh("pyvista", np.asarray(grid.points, dtype=float), np.diff(offsets), np.asarray(grid.cell_connectivity), np.asarray(grid.celltypes),
                 dict(grid.point_data), dict(grid.cell_data), names, tag_field, [])


def to_pyvista(mesh):
    """Makes a pyvista.UnstructuredGrid with all cells, labelled facets, tags ("physical_tag"), names of groups, and data of a Mesh."""
    import pyvista
    grid = _core.to_grid(mesh, True)
    lengths = np.diff(grid["offsets"])
    cells = np.insert(grid["nodes"], grid["offsets"][:-1], lengths)
    result = pyvista.UnstructuredGrid(cells, grid["types"], grid["points"])
    for name, values in grid["point_data"].items():
        result.point_data[name] = values
    for name, values in grid["cell_data"].items():
        result.cell_data[name] = values
    if mesh.names:
        result.field_data["physical_name"] = np.frombuffer(_lines(mesh.names).encode(), dtype=np.uint8)
    return result


def _type(name):
    known = name.rstrip("0123456789") if name.startswith("polygon") else name
    if known not in _TYPES:
        raise _core.InputError(f"meshio: cells of the type '{name}' cannot be taken; take cells of order 1 or 2: {', '.join(_TYPES)}")
    return _TYPES[known]


def _kinds(grid):
    """Returns the types of cells with their numbers of nodes, in the order of their first cells."""
    kinds = np.stack([grid["types"], np.diff(grid["offsets"])], axis=1)
    unique, first = np.unique(kinds, axis=0, return_index=True)
    return [tuple(int(n) for n in unique[k]) for k in np.argsort(first)]


def _lines(names):
    return "".join(f"{dim} {tag} {name}\n" for (dim, tag), name in names.items())


def _mesh(origin, points, lengths, nodes, types, point_data, cell_data, names, tag_field, lost):
    offsets = np.concatenate([[0], np.cumsum(lengths)])
    mesh, notes = _core.from_grid(origin, points, offsets, nodes, types, point_data, cell_data, _lines(names), tag_field)
    for note in [*notes, *(f"{what} are left out" for what in lost)]:
        warnings.warn(f"{origin}: {note}", stacklevel=3)
    return mesh
