# SPDX-License-Identifier: GPL-3.0-or-later
"""Curved edges of planar cells of second order: parabolas through three nodes, as Bezier curves."""

import numpy as np
from matplotlib.path import Path


def midside_nodes(grid):
    """The node in the middle of each edge of edges_of(grid), shape (n,); -1 for edges of linear cells."""
    sizes, rows = np.diff(grid.offsets), np.diff(grid.curved.offsets)
    found = np.full(len(grid.connectivity), -1)
    places = np.arange(len(grid.connectivity)) - np.repeat(grid.offsets[:-1], sizes)
    starts = np.repeat(grid.curved.offsets[:-1] + sizes, sizes)  # after the corners follow the edges, in the same order
    has = np.repeat(rows > sizes, sizes)
    found[has] = grid.curved.connectivity[(starts + places)[has]]
    return found


def control_points(grid, edges):
    """The second control point of each edge's parabola, shape (n, 2); the first and the last are its ends. A straight
    edge of a linear cell has its middle."""
    points = grid.points[:, :2]
    middles = 0.5 * (points[edges[:, 0]] + points[edges[:, 1]])
    nodes = midside_nodes(grid)
    return np.where(nodes[:, None] < 0, middles, 2 * points[nodes] - middles)


def extremes(tails, controls, heads):
    """(low, high) of the coordinates of parabolas, each of shape (n, 2)."""
    bend = tails - 2 * controls + heads
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (tails - controls) / bend
    t = np.where((t > 0) & (t < 1), t, 0.0)  # false for NaN, too
    turn = (1 - t)**2 * tails + 2 * t * (1 - t) * controls + t**2 * heads
    several = np.stack([tails, turn, heads])
    return several.min(axis=0), several.max(axis=0)


def curved_path(tails, controls, heads):
    """A closed path of consecutive parabolas."""
    vertices = np.empty((2 * len(tails) + 2, 2))
    vertices[0] = vertices[-1] = tails[0]
    vertices[1:-1:2], vertices[2:-1:2] = controls, heads
    return Path(vertices, [Path.MOVETO] + [Path.CURVE3] * (2 * len(tails)) + [Path.CLOSEPOLY])
