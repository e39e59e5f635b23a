# SPDX-License-Identifier: GPL-3.0-or-later
"""Curved edges of cells of second order, for pictures."""

import numpy as np

from . import _core

PIECES = 8  # along an edge in space; planar edges are drawn as they are
# The edges of each type of volume cells and the quadrilateral faces, by corners, in the order of their midside nodes.
EDGES = {"tetra": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
         "pyramid": [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)],
         "wedge": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
         "hexahedron": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]}


def rows_of(mesh):
    """Yields the corners and the midside nodes of each cell, in the order of mesh.cells_dict; linear cells have no midside nodes."""
    for name, rows in mesh.cells_dict.items():
        for row, midside in zip(rows, mesh.midside_nodes[name]):
            yield name, row, midside


def paths(mesh):
    """Returns the outlines of planar cells: each edge is a parabola through its three nodes, a Bezier curve of degree 2."""
    from matplotlib.path import Path
    found = []
    for _, row, midside in rows_of(mesh):
        ends = mesh.points[row]
        heads = np.roll(ends, -1, axis=0)
        middles = 0.5 * (ends + heads)
        vertices = np.empty((2 * len(row) + 2, 2))
        vertices[0] = vertices[-1] = ends[0]
        vertices[1:-1:2] = 2 * mesh.points[midside[:len(row)]] - middles if len(midside) else middles
        vertices[2:-1:2] = heads
        found.append(Path(vertices, [Path.MOVETO] + [Path.CURVE3] * (2 * len(row)) + [Path.CLOSEPOLY]))
    return found


def triangles(mesh, values):
    """Returns small triangles of planar cells: points (n, 2), rows (m, 3) of these, and values at the points from those at the nodes."""
    at_nodes, points, rows, first = np.column_stack([mesh.points, values]), [], [], 0
    for _, row, midside in rows_of(mesh):
        if len(midside):
            places, small = lattice(len(row))
            points.append(_core.shape_values(2, len(row) + len(midside), places) @ at_nodes[[*row, *midside]])
        else:
            points.append(at_nodes[row])
            small = np.array([(0, k, k + 1) for k in range(1, len(row) - 1)])
        rows.append(first + small)
        first += len(points[-1])
    points = np.concatenate(points)
    return points[:, :2], np.concatenate(rows), points[:, 2]


def lattice(n_corners):
    """Returns points of the reference triangle or square with PIECES along each edge, and the triangles between them."""
    places = [(i, j) for i in range(PIECES + 1) for j in range(PIECES + 1 - (i if n_corners == 3 else 0))]
    number = {place: k for k, place in enumerate(places)}
    small = [[(i, j), (i + 1, j), (i, j + 1)] for i, j in places] + [[(i + 1, j), (i + 1, j + 1), (i, j + 1)] for i, j in places]
    return np.array(places) / PIECES, np.array([[number[at] for at in row] for row in small if all(at in number for at in row)])


def outlines(mesh, faces):
    """Returns the outlines of faces, rows of corners, of volume meshes or surfaces as points in space along their curved edges."""
    nodes = {}
    for name, row, midside in rows_of(mesh):
        edges = EDGES[name] if mesh.dim == 3 else [(k, (k + 1) % len(row)) for k in range(len(row))]
        nodes.update((frozenset((row[a], row[b])), node) for (a, b), node in zip(edges, midside))
    t = np.arange(PIECES)[:, None] / PIECES
    found = []
    for face in faces:
        parts = []
        for a, b in zip(face, np.roll(face, -1)):
            start, end = mesh.points[a], mesh.points[b]
            node = nodes.get(frozenset((a, b)))
            middle = 0.5 * (start + end) if node is None else mesh.points[node]
            parts.append((1 - t) * (1 - 2 * t) * start + 4 * t * (1 - t) * middle + t * (2 * t - 1) * end)
        found.append(np.concatenate(parts))
    return found
