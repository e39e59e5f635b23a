# SPDX-License-Identifier: GPL-3.0-or-later
"""Curved edges of cells of second order, for pictures."""

import numpy as np

from . import _core

PIECES = 8  # along an edge, of planar cells with values at the nodes
PIECES_IN_SPACE = 4


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
            places, small = lattice(len(row), PIECES)
            points.append(_core.shape_values(2, len(row) + len(midside), places) @ at_nodes[[*row, *midside]])
        else:
            points.append(at_nodes[row])
            small = np.array([(0, k, k + 1) for k in range(1, len(row) - 1)])
        rows.append(first + small)
        first += len(points[-1])
    points = np.concatenate(points)
    return points[:, :2], np.concatenate(rows), points[:, 2]


def lattice(n_corners, n):
    """Returns points of the reference triangle or square with n pieces along each edge, and the triangles between them."""
    places = [(i, j) for i in range(n + 1) for j in range(n + 1 - (i if n_corners == 3 else 0))]
    number = {place: k for k, place in enumerate(places)}
    small = [[(i, j), (i + 1, j), (i, j + 1)] for i, j in places] + [[(i + 1, j), (i + 1, j + 1), (i, j + 1)] for i, j in places]
    return np.array(places) / n, np.array([[number[at] for at in row] for row in small if all(at in number for at in row)])


def midside_nodes(mesh):
    """Returns {corners of an edge or a face: its midside node}."""
    return {frozenset(corners): node for corners, node in _core.midside_places(mesh)}


def pieces(mesh, faces):
    """Returns flat pieces of curved faces, rows of corners: polygons in space, and the number of the face of each. Then the pieces of the
    edges, each of two points."""
    nodes, polygons, numbers, edges = midside_nodes(mesh), [], [], {}
    for number, face in enumerate(np.asarray(row) for row in faces):
        sides = [frozenset(side) for side in zip(face.tolist(), np.roll(face, -1).tolist())]
        of_face = [nodes[side] for side in sides if side in nodes]  # all or none
        edges.update((side, nodes.get(side)) for side in sides)
        if of_face:
            middle = nodes.get(frozenset(face.tolist()))
            row = [*face, *of_face] + ([] if middle is None else [middle])
            places, small = lattice(len(face), PIECES_IN_SPACE)
            points = _core.shape_values(2, len(row), places) @ mesh.points[row]
            polygons.extend(points[small])
        else:
            polygons.append(mesh.points[face])
        numbers.extend([number] * (len(polygons) - len(numbers)))
    return polygons, np.array(numbers), [piece for side, node in edges.items() for piece in edge_pieces(mesh, sorted(side), node)]


def edge_pieces(mesh, ends, node):
    """Returns the pieces (2, 3) of an edge; node: in its middle, or None."""
    start, end = mesh.points[ends]
    if node is None:
        return [np.array([start, end])]
    t = np.arange(PIECES_IN_SPACE + 1)[:, None] / PIECES_IN_SPACE
    line = (1 - t) * (1 - 2 * t) * start + 4 * t * (1 - t) * mesh.points[node] + t * (2 * t - 1) * end
    return [line[k:k + 2] for k in range(PIECES_IN_SPACE)]
