# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry for drawing planar meshes: boundary loops, polygons, triangles, windows."""

import numpy as np
from matplotlib.path import Path

from .planar_curves import control_points, curved_path, extremes

LEAST_FILLED = 0.5  # of the area of a detail
SMALLER_WINDOWS = (1.0, 0.7, 0.5, 0.35)  # than wanted, where a domain is too narrow


def edges_of(grid):
    """All directed edges of the cells as (n, 2) node numbers; each cell is walked around once."""
    following = np.roll(grid.connectivity, -1)
    # The last node of a cell is followed by its first one, not by the next cell's.
    following[grid.offsets[1:] - 1] = grid.connectivity[grid.offsets[:-1]]
    return np.column_stack([grid.connectivity, following])


def parabolas_of(grid):
    """(first, second, third) control points of all edges of edges_of(grid) of a curved grid, each of shape (n, 2)."""
    edges = edges_of(grid)
    return grid.points[edges[:, 0], :2], control_points(grid, edges), grid.points[edges[:, 1], :2]


def boundary_loops(grid):
    """The closed boundary curves as lists of node numbers, each starting at its smallest number.

    A directed edge is on the boundary if no cell has its reverse. Counterclockwise cells give a
    counterclockwise outer curve and clockwise holes.
    """
    edges = edges_of(grid)
    present = set(map(tuple, edges.tolist()))
    successors = {}
    for tail, head in sorted(present):
        if (head, tail) not in present:
            successors.setdefault(tail, []).append(head)
    loops = []
    while successors:
        start = node = min(successors)
        loop = []
        while node in successors:  # a node where two curves touch has two successors
            loop.append(node)
            heads = successors[node]
            node = heads.pop(0)
            if not heads:
                del successors[loop[-1]]
            if node == start:
                break
        loops.append(loop)
    return loops


def outline_path(grid):
    """The domain as one compound path; the opposite sense of the holes keeps them unfilled."""
    if grid.curved:
        number = {edge: k for k, edge in enumerate(map(tuple, edges_of(grid).tolist()))}
        parabolas, loops = parabolas_of(grid), boundary_loops(grid)
        edges = [[number[edge] for edge in zip(loop, loop[1:] + loop[:1])] for loop in loops]
        return Path.make_compound_path(*(curved_path(*(points[part] for points in parabolas)) for part in edges))
    vertices, codes = [], []
    for loop in boundary_loops(grid):
        points = grid.points[loop, :2]
        vertices += [points, points[:1]]
        codes += [Path.MOVETO] + [Path.LINETO] * (len(loop) - 1) + [Path.CLOSEPOLY]
    return Path(np.concatenate(vertices), codes)


def triangles_of(grid):
    """The cells split into triangles by fans from their first nodes, shape (n, 3)."""
    sizes = np.diff(grid.offsets)
    starts = grid.offsets[:-1]
    fans = [np.column_stack([grid.connectivity[starts[sizes > k + 1]],
                             grid.connectivity[starts[sizes > k + 1] + k],
                             grid.connectivity[starts[sizes > k + 1] + k + 1]])
            for k in range(1, int(sizes.max()) - 1)]
    return np.concatenate(fans)


def polygons_of(grid, chosen=None):
    """Corner coordinates (k, 2) of all cells or of those with `chosen` true."""
    cells = range(len(grid.types)) if chosen is None else np.flatnonzero(chosen)
    points = grid.points[:, :2]
    return [points[grid.connectivity[grid.offsets[c]:grid.offsets[c + 1]]] for c in cells]


def paths_of(grid, chosen=None):
    """The outlines of all cells of a curved grid, or of those with `chosen` true."""
    cells = range(len(grid.types)) if chosen is None else np.flatnonzero(chosen)
    parabolas = parabolas_of(grid)
    parts = (slice(grid.offsets[c], grid.offsets[c + 1]) for c in cells)
    return [curved_path(*(points[part] for points in parabolas)) for part in parts]


def centroids(grid):
    """The mean of each cell's corners, shape (n_cells, 2)."""
    sums = np.add.reduceat(grid.points[grid.connectivity, :2], grid.offsets[:-1], axis=0)
    return sums / np.diff(grid.offsets)[:, None]


def bounding_box(grid):
    """(x_min, y_min, x_max, y_max)."""
    low, high = extremes(*parabolas_of(grid)) if grid.curved else (grid.points[:, :2], grid.points[:, :2])
    return (*low.min(axis=0), *high.max(axis=0))


def areas(grid):
    """The area of each cell, shape (n_cells,); those of cells that overlap themselves cancel."""
    tails, heads = np.moveaxis(grid.points[edges_of(grid), :2], 1, 0)
    doubled = cross(tails, heads)
    if grid.curved:
        tails, controls, heads = parabolas_of(grid)
        doubled = (2 * cross(tails, controls) + 2 * cross(controls, heads) + doubled) / 3
    return 0.5 * np.abs(np.add.reduceat(doubled, grid.offsets[:-1]))


def cross(a, b):
    """The third component of the cross product of vectors (n, 2)."""
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def window_of(grid, centre, width, aspect):
    """A window (x_min, y_min, x_max, y_max) around a relative position in the bounding box.

    `width` is relative to the longer side of the box, `aspect` is width over height. If not even half
    of the window would be filled by cells (on a narrow domain, near a hole or a corner), it moves to
    the nearest place where it is, and where there is none it gets smaller.
    """
    x_min, y_min, x_max, y_max = bounding_box(grid)
    sides = np.array([x_max - x_min, y_max - y_min])
    wanted = np.array([x_min, y_min]) + np.asarray(centre) * sides
    cells, sizes = centroids(grid), areas(grid)
    # The wanted place, then some hundreds of others, the nearest first.
    others = cells[::max(1, len(cells) // 400)]
    places = np.vstack([wanted, others[np.argsort(((others - wanted) ** 2).sum(axis=1), kind="stable")]])
    for factor in SMALLER_WINDOWS:
        half = 0.5 * factor * width * sides.max() * np.array([1.0, 1.0 / aspect])
        filled = [sizes[np.all(np.abs(cells - place) < half, axis=1)].sum() / (4 * half.prod())
                  for place in places]
        enough = np.flatnonzero(np.array(filled) >= LEAST_FILLED)
        if len(enough):
            break
    middle = places[enough[0] if len(enough) else int(np.argmax(filled))]
    return (*(middle - half), *(middle + half))


def cells_in(grid, window):
    """A mask of the cells whose bounding boxes meet the window, shape (n_cells,)."""
    points = grid.points[grid.connectivity, :2]
    low, high = extremes(*parabolas_of(grid)) if grid.curved else (points, points)
    low = np.minimum.reduceat(low, grid.offsets[:-1], axis=0)
    high = np.maximum.reduceat(high, grid.offsets[:-1], axis=0)
    return ((high >= window[:2]) & (low <= window[2:])).all(axis=1)
