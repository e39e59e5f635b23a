# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces of grids with cells of second order, and their flat pieces."""

from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from ..results.cell_types import CELL_DIMENSIONS, SECOND_ORDER
from .shape_functions import faces_of_cell, planar_pieces, shape_derivatives, shape_values

TRIANGLE, POLYGON = 5, 7
MOST_FINE_FACES = 5000  # with FINE_PIECES along an edge; more faces are small in a picture
FINE_PIECES, PIECES = 8, 4


def pieces_along_edges(n_faces):
    """The number of pieces of each edge that make a picture of so many faces look smooth."""
    return FINE_PIECES if n_faces <= MOST_FINE_FACES else PIECES


@dataclass(frozen=True)
class Faces:
    """Faces of one of VTK's planar types."""

    kind: int
    nodes: np.ndarray  # (n, nodes of the type), corners first
    cells: np.ndarray  # (n,): the cell of each
    are_edges: Optional[np.ndarray] = None  # (n, edges): which sides are edges of the cell; None: all

    def chosen(self, mask):
        """Those of a mask."""
        return replace(self, nodes=self.nodes[mask], cells=self.cells[mask])

    def keys(self, n_points):
        """A number for each face that two faces have in common only if they have the same corners, as in face_keys."""
        corners = np.sort(self.nodes[:, :SECOND_ORDER[self.kind][1] if self.kind in SECOND_ORDER else None], axis=1)
        return (corners[:, 0] * n_points + corners[:, 1]) * n_points + corners[:, 2]

    def interpolated(self, values, n):
        """Values (n_points, ...) at the points of all faces with n pieces along each edge: shape (faces, points, ...)."""
        weights = shape_values(self.kind, planar_pieces(self.kind, n).points)
        return np.einsum("pk,fk...->fp...", weights, values[self.nodes])

    def normals(self, points, n):
        """Unit normals at these points, shape (faces, points, 3); 0 where a face is degenerate."""
        derivatives = shape_derivatives(self.kind, planar_pieces(self.kind, n).points)
        along = np.einsum("dpk,fkc->dfpc", derivatives, points[self.nodes])
        normals = np.cross(along[0], along[1])
        return normals / np.maximum(np.linalg.norm(normals, axis=2, keepdims=True), np.finfo(float).tiny)

    def n_points(self, n):
        """The number of points of all faces with n pieces along each edge."""
        return len(self.nodes) * len(planar_pieces(self.kind, n).points)

    def triangles(self, n, first=0):
        """Triangles of these points, numbered face by face from `first`: shape (faces, triangles, 3)."""
        return first + self._numbered(planar_pieces(self.kind, n).triangles, n)

    def lines(self, n, first=0):
        """Points along the edges, numbered in the same way: shape (faces, edges, n + 1)."""
        return first + self._numbered(planar_pieces(self.kind, n).edges, n)

    def _numbered(self, rows, n):
        return np.arange(len(self.nodes))[:, None, None] * len(planar_pieces(self.kind, n).points) + rows


def all_faces(grid, chosen=None):
    """The faces of the cells of a curved grid, or of those of a mask, as a list by type; planar cells are faces themselves, and
    polygons are split into triangles."""
    cells, found = grid.curved, {}
    polygons = polygons_as_triangles(grid)
    for kind in np.setdiff1d(cells.types, [POLYGON]):
        numbers = np.flatnonzero(cells.types == kind if chosen is None else (cells.types == kind) & chosen)
        if not len(numbers):
            continue
        size = cells.offsets[numbers[0] + 1] - cells.offsets[numbers[0]]
        rows = cells.connectivity[cells.offsets[numbers][:, None] + np.arange(size)]
        volume = CELL_DIMENSIONS[int(kind)] == 3
        for face, positions in faces_of_cell(int(kind)) if volume else [(int(kind), range(size))]:
            found.setdefault(face, []).append((rows[:, list(positions)], numbers))
    return [Faces(kind, *map(np.concatenate, zip(*parts))) for kind, parts in found.items()] + polygons


def polygons_as_triangles(grid):
    """A list of the fans of all polygons as Faces; empty without polygons, which only planar meshes and surfaces have."""
    found, cells = [], grid.curved
    for c in np.flatnonzero(cells.types == POLYGON):
        nodes = cells.connectivity[cells.offsets[c]:cells.offsets[c + 1]]
        last = len(nodes) - 2
        found += [(c, (nodes[0], nodes[k], nodes[k + 1]), (k == 1, True, k == last)) for k in range(1, last + 1)]
    if not found:
        return []
    numbers, rows, are_edges = map(np.array, zip(*found))
    return [Faces(TRIANGLE, rows, numbers, are_edges)]


def outer_faces(grid, chosen=None):
    """The faces that one of the chosen cells has alone."""
    faces = all_faces(grid, chosen)
    keys = [part.keys(len(grid.points)) for part in faces]
    seen, counts = np.unique(np.concatenate([np.empty(0, dtype=np.int64), *keys]), return_counts=True)
    once = seen[counts == 1]
    return [part.chosen(np.isin(key, once)) for part, key in zip(faces, keys)]


def triangles_of_curved(grid, values):
    """Flat triangles of a planar grid: values (n_points, m) at their corners, shape (n, 3, m)."""
    faces = all_faces(grid)
    n = pieces_along_edges(len(grid.types))
    return np.concatenate([part.interpolated(values, n)[:, planar_pieces(part.kind, n).triangles].reshape(-1, 3, values.shape[1])
                           for part in faces])


def distinct_edges(faces):
    """A list of masks (faces, edges), one for each type: the first of all edges with the same ends."""
    ends, sizes = [], []
    for part in faces:
        n_corners = planar_pieces(part.kind, 1).edges.shape[0]
        corners = part.nodes[:, :n_corners]
        ends.append(np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=2), axis=2).reshape(-1, 2))
        sizes.append(corners.shape)
    _, first = np.unique(np.concatenate([np.empty((0, 2), dtype=np.int64), *ends]), axis=0, return_index=True)
    mask = np.zeros(sum(map(len, ends)), dtype=bool)
    mask[first] = True
    parts = np.split(mask, np.cumsum([len(rows) for rows in ends])[:-1])
    return [part.reshape(size) & (True if of_type.are_edges is None else of_type.are_edges)
            for of_type, part, size in zip(faces, parts, sizes)]
