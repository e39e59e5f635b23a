# SPDX-License-Identifier: GPL-3.0-or-later
"""Values given at the nodes of a planar mesh, at the points of a picture."""

import numpy as np

from .curved_faces import triangles_of_curved
from .planar_geometry import bounding_box, triangles_of

MOST_SAMPLES = 1 << 22  # at a time: what they need of memory


def resampled(grid, values, width):
    """Samples values in the middles of the pixels of an array of so many columns over the bounding box of a mesh, the
    first row at the bottom. Values are linear on triangles, into which other cells are split, also curved ones. Outside of the mesh they
    are NaN, but pixels next to it have the values of their neighbours."""
    x_min, y_min, x_max, y_max = bounding_box(grid)
    scale = width / (x_max - x_min)
    picture = np.full((max(1, round(scale * (y_max - y_min))), width), np.nan)
    # In pixels, whose middles are at whole numbers.
    values = np.column_stack([grid.points[:, :2], values])  # of each node
    at_corners = triangles_of_curved(grid, values) if grid.curved else values[triangles_of(grid)]
    corners, numbers = (at_corners[:, :, :2] - (x_min, y_min)) * scale - 0.5, at_corners[:, :, 2]
    first = np.floor(corners.min(axis=1)).astype(int)
    sizes = (np.ceil(corners.max(axis=1)).astype(int) + 1 - first).max(axis=1)
    for size in np.unique(1 << np.ceil(np.log2(sizes)).astype(int)):
        chosen = np.flatnonzero((sizes <= size) & (2 * sizes > size))
        for part in np.array_split(chosen, len(chosen) * size**2 // MOST_SAMPLES + 1):
            fill(picture, corners[part], numbers[part], first[part], int(size))
    return widened(picture)


def widened(picture):
    """The picture with its border moved outwards by a pixel: the outline of a domain cuts through
    pixels whose middles are outside."""
    for axis in (0, 1):
        for step in (1, -1):
            picture = np.where(np.isnan(picture), np.roll(picture, step, axis), picture)
    return picture


def fill(picture, corners, numbers, first, size):
    """Writes what triangles (n, 3, 2) with numbers (n, 3) at their corners have in the squares of so
    many pixels that begin at `first` (n, 2)."""
    a, b, c = np.moveaxis(corners, 1, 0)
    area = cross(b - a, c - a)
    whole = area != 0
    a, b, c, area, numbers, first = a[whole], b[whole], c[whole], area[whole], numbers[whole], first[whole]
    height, width = picture.shape
    x = first[:, 0, None] + np.arange(size)  # (n, size)
    y = first[:, 1, None] + np.arange(size)
    inside = ((y >= 0) & (y < height))[:, :, None] & ((x >= 0) & (x < width))[:, None, :]  # (n, row, column)
    value = np.zeros(inside.shape)
    # The weight of a corner is linear in x and y: a sum of a term for each column and one for each row.
    for number, (p, q) in enumerate(((b, c), (c, a), (a, b))):
        edge = (q - p) / area[:, None]
        weight = ((y - p[:, 1, None]) * edge[:, 0, None])[:, :, None] - ((x - p[:, 0, None]) * edge[:, 1, None])[:, None, :]
        inside &= weight >= -1e-9
        weight *= numbers[:, number, None, None]
        value += weight
    triangle, row, column = np.nonzero(inside)
    picture[y[triangle, row], x[triangle, column]] = value[inside]


def cross(a, b):
    """The third component of the cross product of vectors (..., 2)."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
