# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape functions of VTK's cells of order 1 and 2, and pieces of these cells."""

import itertools
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..results.cell_types import SECOND_ORDER
from ..results.vtu import vtk_module

TRIANGLES = (5, 22, 34)
TETRAHEDRON, PRISM, PYRAMID = 10, 13, 14
PRISM_BASE, HEXAHEDRON_BASE = 5, 9
SEVEN_NODES = 34
PYRAMIDS = (PYRAMID, 27)


def total_degree(dim, degree):
    """Powers of the coordinates with a sum up to a degree."""
    return [p for p in itertools.product(range(degree + 1), repeat=dim) if sum(p) <= degree]


def serendipity(dim):
    """Products of powers with at most one square."""
    return [p for p in itertools.product(range(3), repeat=dim) if p.count(2) <= 1]


# Powers (i, j, ...) of the functions x^i y^j ... that span the shape functions of a type. Triangles of seven nodes have another
# one. In pyramids the functions are xi^i eta^j (1-z)^max(i,j) z^k with xi = x/(1-z), eta = y/(1-z).
POWERS = {5: total_degree(2, 1), 9: list(itertools.product(range(2), repeat=2)),
          22: total_degree(2, 2), 34: total_degree(2, 2), 23: serendipity(2), 28: list(itertools.product(range(3), repeat=2)),
          10: total_degree(3, 1), 24: total_degree(3, 2),
          12: list(itertools.product(range(2), repeat=3)), 25: serendipity(3), 29: list(itertools.product(range(3), repeat=3)),
          13: [(*p, k) for p in total_degree(2, 1) for k in range(2)],
          26: [(*p, k) for p in total_degree(2, 2) for k in range(3) if k < 2 or sum(p) < 2],
          32: [(*p, k) for p in total_degree(2, 2) for k in range(3)],
          14: [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 0, 1)],
          27: [(i, j, k) for i in range(3) for j in range(3) for k in range(3 - max(i, j)) if i + j < 4]}


def vtk_cell(kind):
    """VTK's cell of a type, whose point k has the number k."""
    cell = vtk_module("vtkCommonDataModel").vtkGenericCell.InstantiateCell(kind)
    for k in range(cell.GetNumberOfPoints()):
        cell.GetPointIds().SetId(k, k)
    return cell


@lru_cache
def faces_of_cell(kind):
    """The faces of a type of volume cells: (type, positions in a row) of each, corners first."""
    cell, found = vtk_cell(kind), []
    for number in range(cell.GetNumberOfFaces()):
        face = cell.GetFace(number)  # the same object each time
        found.append((face.GetCellType(), [face.GetPointIds().GetId(k) for k in range(face.GetNumberOfPoints())]))
    return found


@lru_cache
def nodes_of(kind):
    """Reference coordinates of a type's nodes, shape (n, dimension). Those of pyramids have the apex (0, 0, 1)."""
    cell = vtk_cell(kind)
    nodes = np.reshape(cell.GetParametricCoords(), (-1, 3))[:, :cell.GetCellDimension()]
    if kind in PYRAMIDS:  # VTK's apex of five nodes is (1/2, 1/2, 1)
        nodes = nodes - nodes[:, 2:] * (*nodes[4, :2], 0)
    return nodes


def spanning_functions(kind, points):
    """Values of the functions of POWERS at points (n, dimension), shape (n, n_functions)."""
    powers = np.array(POWERS[kind])
    if kind in PYRAMIDS:
        rest = 1.0 - points[:, 2:]
        flat = np.divide(points[:, :2], rest, out=np.zeros((len(points), 2)), where=rest > 0)
        collapsed = np.column_stack([flat, points[:, 2]])
        return np.prod(collapsed[:, None]**powers, axis=2) * rest**powers[:, :2].max(axis=1)
    values = np.prod(points[:, None]**powers, axis=2)
    if kind == SEVEN_NODES:
        values = np.column_stack([values, points.prod(axis=1) * (1 - points.sum(axis=1))])
    return values


def shape_values(kind, points):
    """Values of all shape functions of a type at points (n, dimension) of its reference cell, shape (n, n_nodes)."""
    return spanning_functions(kind, points) @ np.linalg.inv(spanning_functions(kind, nodes_of(kind)))


def shape_derivatives(kind, points):
    """Derivatives of the shape functions of planar cells, shape (2, n, n_nodes): functions of degree 2 in each coordinate
    have their central differences as derivatives."""
    return np.stack([shape_values(kind, points + 0.5 * step) - shape_values(kind, points - 0.5 * step) for step in np.eye(2)])


@dataclass(frozen=True)
class Pieces:
    """Linear pieces of a reference cell."""

    points: np.ndarray  # (n, dimension)
    cells: np.ndarray  # (n, corners): of triangles or quadrilaterals, or of volume cells of the type `kind`
    edges: np.ndarray = None  # (n_edges, n): points along the edges of planar cells
    kind: int = 0

    @property
    def triangles(self):
        """Planar pieces as triangles."""
        return self.cells if self.cells.shape[1] == 3 else np.vstack([self.cells[:, [0, 1, 2]], self.cells[:, [0, 2, 3]]])


@lru_cache
def planar_pieces(kind, n):
    """A planar cell with n pieces along each edge."""
    triangle = kind in TRIANGLES
    numbers = {(i, j): None for i in range(n + 1) for j in range(n + 1 - (i if triangle else 0))}
    numbers = {at: number for number, at in enumerate(numbers)}
    squares = [[(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)] for i in range(n) for j in range(n - (i if triangle else 0))]
    cells = squares
    if triangle:
        cells = [[a, b, d] for a, b, _, d in squares] + [[b, c, d] for _, b, c, d in squares if c in numbers]
    corners = [(0, 0), (n, 0), (0, n)] if triangle else [(0, 0), (n, 0), (n, n), (0, n)]
    edges = [[tuple(((n - k) * np.array(a) + k * np.array(b)) // n) for k in range(n + 1)]
             for a, b in zip(corners, corners[1:] + corners[:1])]
    return Pieces(np.array(list(numbers)) / n, *(np.array([[numbers[at] for at in row] for row in rows]) for rows in (cells, edges)))


@lru_cache
def volume_pieces(kind, n):
    """A volume cell with n pieces along each edge: tetrahedra, hexahedra or prisms, like the cell, or tetrahedra in a pyramid. So
    pieces of neighbours have the same edges, except between a pyramid and a hexahedron."""
    of_corners = SECOND_ORDER[kind][0] if kind in SECOND_ORDER else kind
    if of_corners in (TETRAHEDRON, PYRAMID):
        corners = nodes_of(of_corners)  # coordinates 0 and 1
        halves = [(0, 1, 2, 3)] if of_corners == TETRAHEDRON else [(0, 1, 2, 4), (0, 2, 3, 4)]
        places = np.concatenate([small_tetrahedra(n) @ corners[list(half)] for half in halves])
        points, numbers = np.unique(places.reshape(-1, 3), axis=0, return_inverse=True)
        return Pieces(points / n, numbers.reshape(-1, 4), kind=TETRAHEDRON)
    flat = planar_pieces(PRISM_BASE if of_corners == PRISM else HEXAHEDRON_BASE, n)
    points = np.vstack([np.column_stack([flat.points, np.full(len(flat.points), k / n)]) for k in range(n + 1)])
    bottom = np.vstack([k * len(flat.points) + flat.cells for k in range(n)])
    return Pieces(points, np.hstack([bottom, bottom + len(flat.points)]), kind=of_corners)


def small_tetrahedra(n):
    """The n^3 tetrahedra of a large one: barycentric coordinates of their corners, times n, shape (n^3, 4, 4)."""
    # Of the six tetrahedra of each small cube, those with 1 >= x >= y >= z.
    small = []
    for corner in itertools.product(range(n), repeat=3):
        for order in itertools.permutations(range(3)):
            path = np.cumsum(np.vstack([corner, np.eye(3, dtype=int)[list(order)]]), axis=0)
            if (np.diff(path, axis=1) <= 0).all():
                small.append(path)
    x, y, z = np.moveaxis(np.array(small), -1, 0)
    return np.stack([n - x, x - y, y - z, z], axis=-1)
