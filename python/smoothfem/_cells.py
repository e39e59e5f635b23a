# SPDX-License-Identifier: GPL-3.0-or-later
"""Creates meshes from cells of one type or of different types."""

import numpy as np

from ._arguments import foreign_mesh, shown, wrong
from ._core import InputError, Mesh, second_order_types

# meshio's names -> dimension, number of nodes (None: any).
TYPES = {"vertex": (0, 1), "line": (1, 2), "triangle": (2, 3), "quad": (2, 4), "polygon": (2, None), "tetra": (3, 4), "pyramid": (3, 5),
         "wedge": (3, 6), "hexahedron": (3, 8)}
# meshio's names of cells of second order -> dimension, number of corners, positions of the nodes in the program's order.
SECOND_ORDER = {name: (dim, n_corners, positions) for name, _, dim, n_corners, positions in second_order_types()}


_create = Mesh.__init__  # of the compiled class


def create(self, points, cells=None, *, fixed=None, dim=None, cell_type=None):
    """Creates a mesh.

    points: (n, 2) or (n, 3) finite numbers. cells: an array (n, k), or a sequence of sequences, of node numbers, counted from 0; planar cells are
    counterclockwise. Or {meshio's name of a type: array}, also of second order, for example "tetra10", whose entries of lower dimension, such as edges, are left out. fixed: the nodes that
    smoothing must not move, as numbers or as n truth values (default: nodes of the boundary). cell_type: meshio's name of the type, for example
    "quad". dim: dimension of the cells, 2 or 3 (default: that of the types, otherwise the number of coordinates of a point); with points in space and
    dim=2 the mesh is a surface. If types are named, points of planar cells may have a constant z. Raises InputError that names the first invalid cell.
    """
    rows, dim_of_types, midside = rows_of(points, cells, cell_type)
    _create(self, points, rows, fixed, dim, dim_of_types, midside)


create.__qualname__ = "Mesh.__init__"  # in messages


def rows_of(points, cells, cell_type):
    """Returns (rows of corners, dimension of the types or None, rows of midside nodes or None) of the arguments of Mesh()."""
    if cells is None:
        raise InputError(foreign_mesh(points) or "Mesh needs points and cells: Mesh(points, cells)")
    if hasattr(cells, "items"):
        if cell_type is not None:
            raise InputError("cell_type is for one array of cells; leave it out with a dict of arrays")
        return _joined(cells)
    if cell_type is not None:
        return _joined({cell_type: cells})
    if isinstance(cells, (str, bytes)) or not hasattr(cells, "__iter__"):
        raise wrong("cells", cells, "an array or a sequence of sequences of node numbers, or {meshio's name of a type: array}")
    return cells, None, None


def _joined(blocks):
    kinds = {name: _kind(name) for name in blocks}
    dim = max((dim for dim, _ in kinds.values()), default=0)
    if dim < 2:
        raise InputError(f"cells has no planar or volume cells: it has {', '.join(map(str, blocks)) or 'no entries'}")
    rows, midside = [], []
    for name, block in blocks.items():
        of_dim, n_nodes = kinds[name]
        if of_dim < dim:
            continue
        if not hasattr(block, "__iter__"):
            raise wrong(f"cells['{name}']", block, "an array of node numbers")
        _, n_corners, positions = SECOND_ORDER.get(name, (None, None, None))
        for row in block:
            if n_nodes and (not hasattr(row, "__len__") or len(row) != n_nodes):
                raise InputError(f"cells['{name}'] has the row {shown(row)}, but cells of this type have {n_nodes} nodes")
            if positions:
                ordered = [node for _, node in sorted(zip(positions, row))]
                row, others = ordered[:n_corners], ordered[n_corners:]
            rows.append(row)
            midside.append(np.array(others if positions else [], dtype=np.int64))
    return rows, dim, midside if any(len(nodes) for nodes in midside) else None


def _kind(name):
    if name in SECOND_ORDER:
        dim, _, positions = SECOND_ORDER[name]
        return dim, len(positions)
    known = name.rstrip("0123456789") if isinstance(name, str) and name.startswith("polygon") else name
    if known not in TYPES:
        raise InputError(f"cells of the type {shown(name)} cannot be taken; take cells of order 1 or 2: {', '.join([*TYPES, *SECOND_ORDER])}")
    return TYPES[known]
