# SPDX-License-Identifier: GPL-3.0-or-later
"""Sections of the cells of a volume mesh by a plane."""

import numpy as np

from .volume_geometry import unit, upwards

# Edges of VTK_TETRA, VTK_HEXAHEDRON, VTK_WEDGE and VTK_PYRAMID.
EDGES = {10: ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
         12: ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4),
              (0, 4), (1, 5), (2, 6), (3, 7)),
         13: ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)),
         14: ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4))}


def in_plane(points, cut):
    """Coordinates of points (n, 3) along the plane of a cut, to the right and upwards: shape (n, 2)."""
    normal = unit(cut.normal)
    up = upwards(normal)
    return points @ np.column_stack([np.cross(up, normal), up])


def area_of(polygon):
    """The area of corners (k, 2)."""
    x, y = polygon.T
    return 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def section(grid, cut):
    """(polygons, cells): what the plane of a cut has in common with each cell that it crosses, as
    corners (k, 2) in the coordinates of in_plane, and the numbers of these cells.

    Corners lie on the cell's edges, so that neighbours share them. They are joined in the order of
    their directions from their mean: exact for cells with plane faces, which are convex; faces that
    are slightly warped are cut along straight lines.
    """
    flat = in_plane(grid.points, cut)
    heights = (grid.points - cut.origin) @ unit(cut.normal)
    crossed = cut.crossed(grid)
    polygons, cells = [], []
    for kind, edges in EDGES.items():
        chosen = np.flatnonzero(crossed & (grid.types == kind))
        starts = grid.offsets[chosen][:, None]
        tails, heads = (grid.connectivity[starts + np.array(nodes)] for nodes in zip(*edges))
        is_cut = (heights[tails] > 0) != (heights[heads] > 0)
        below = np.where(is_cut, heights[tails] - heights[heads], 1.0)
        fraction = (heights[tails] / below)[..., None]
        corners = (1 - fraction) * flat[tails] + fraction * flat[heads]
        counts = is_cut.sum(axis=1)
        middles = np.where(is_cut[..., None], corners, 0.0).sum(axis=1) / counts[:, None]
        x, y = np.moveaxis(corners - middles[:, None], -1, 0)
        order = np.argsort(np.where(is_cut, np.arctan2(y, x), np.inf), axis=1, kind="stable")
        polygons += [corners[i, order[i, :n]] for i, n in enumerate(counts)]
        cells.append(chosen)
    return polygons, np.concatenate(cells)
