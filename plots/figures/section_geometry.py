# SPDX-License-Identifier: GPL-3.0-or-later
"""Sections of the cells of a volume mesh by a plane."""

import numpy as np

from ..results.vtu import UnstructuredGrid
from .curved_faces import all_faces
from .shape_functions import shape_values, volume_pieces
from .volume_geometry import unit, upwards

SECTION_PIECES = 6  # along each edge of a curved cell
ROUNDING = 1e-10  # of positions, relative to the size of the mesh

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

    Curved cells are cut in pieces, each with a polygon and the number of its cell. Corners of other cells lie on the
    cell's edges, so that neighbours share them. They are joined in the order of
    their directions from their mean: exact for cells with plane faces, which are convex; faces that
    are slightly warped are cut along straight lines.
    """
    if grid.curved:
        pieces, owners = pieces_at(grid, cut)
        polygons, numbers = section(pieces, cut)
        return polygons, owners[numbers]
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


def cells_near(grid, cut):
    """A mask of the cells of a curved grid that the plane of a cut may cross, shape (n_cells,)."""
    cells = grid.curved
    heights = ((grid.points - cut.origin) @ unit(cut.normal))[cells.connectivity]
    low, high = (ends.reduceat(heights, cells.offsets[:-1]) for ends in (np.minimum, np.maximum))
    # Functions of degree 2 exceed the values of their nodes by less than the range of these.
    return (2 * low - high <= 0) & (2 * high - low >= 0)


def onto_plane(points, cut, size):
    """Points (n, 3) in space; where rounding has moved one off the plane of a cut, it moves back, lest cells on both sides are
    cut. size: of the mesh."""
    normal = unit(cut.normal)
    heights = (points - cut.origin) @ normal
    return points - np.where(np.abs(heights) < ROUNDING * size, heights, 0.0)[:, None] * normal


def pieces_at(grid, cut):
    """A grid of the linear pieces of curved cells near the plane of a cut, and the cell of each."""
    near, size = cells_near(grid, cut), np.ptp(grid.points, axis=0).max()
    points, cells, sizes, types, owners, first = [np.empty((0, 3))], [], [], [], [], 0
    for kind in np.unique(grid.curved.types[near]):
        numbers = np.flatnonzero(near & (grid.curved.types == kind))
        pieces = volume_pieces(int(kind), SECTION_PIECES)
        weights = shape_values(int(kind), pieces.points)
        rows = grid.curved.connectivity[grid.curved.offsets[numbers][:, None] + np.arange(weights.shape[1])]
        points.append(np.einsum("pk,ckd->cpd", weights, grid.points[rows]).reshape(-1, 3))
        cells.append((first + len(pieces.points) * np.arange(len(numbers))[:, None, None] + pieces.cells).ravel())
        sizes.append(np.full(len(numbers) * len(pieces.cells), pieces.cells.shape[1]))
        types.append(np.full(len(sizes[-1]), pieces.kind))
        owners.append(np.repeat(numbers, len(pieces.cells)))
        first += len(points[-1])
    cells, sizes, types, owners = (np.concatenate([np.empty(0, dtype=np.int64), *parts]) for parts in (cells, sizes, types, owners))
    return UnstructuredGrid(onto_plane(np.concatenate(points), cut, size), cells, np.concatenate(([0], np.cumsum(sizes))), types,
                            {}, {}), owners


def section_lines(grid, cut):
    """The edges of a section of curved cells: where the plane of a cut crosses their faces, as segments (n, 2, 2) in the
    coordinates of in_plane."""
    size, segments = np.ptp(grid.points, axis=0).max(), [np.empty((0, 2, 2))]
    for faces in all_faces(grid, cells_near(grid, cut)):
        _, first = np.unique(faces.keys(len(grid.points)), return_index=True)
        faces = faces.chosen(first)
        points = onto_plane(faces.interpolated(grid.points, SECTION_PIECES).reshape(-1, 3), cut, size)
        triangles = points[faces.triangles(SECTION_PIECES).reshape(-1, 3)]
        heights = (triangles - cut.origin) @ unit(cut.normal)
        cut_edges = (heights > 0) != (np.roll(heights, -1, axis=1) > 0)  # two of three, or none
        crossed = cut_edges.any(axis=1)
        triangles, heights, cut_edges = triangles[crossed], heights[crossed], cut_edges[crossed]
        heads, next_heights = np.roll(triangles, -1, axis=1)[cut_edges], np.roll(heights, -1, axis=1)[cut_edges]
        tails, heights = triangles[cut_edges], heights[cut_edges]
        fraction = (heights / (heights - next_heights))[:, None]
        segments.append(in_plane((1 - fraction) * tails + fraction * heads, cut).reshape(-1, 2, 2))
    return np.concatenate(segments)
