# SPDX-License-Identifier: GPL-3.0-or-later
"""Values given at the nodes of a planar mesh, at the points of a picture."""

import numpy as np

from .planar_geometry import bounding_box, triangles_of

MOST_SAMPLES = 1 << 22  # at a time: what they need of memory


def resampled(grid, values, width):
    """Samples values in the middles of the pixels of an array of so many columns over the bounding box of a mesh, the
    first row at the bottom. Values are linear on triangles, into which other cells are split. Outside of the mesh they
    are NaN, but pixels next to it have the values of their neighbours."""
    x_min, y_min, x_max, y_max = bounding_box(grid)
    scale = width / (x_max - x_min)
    picture = np.full((max(1, round(scale * (y_max - y_min))), width), np.nan)
    # In pixels, whose middles are at whole numbers.
    points = (grid.points[:, :2] - (x_min, y_min)) * scale - 0.5
    corners = points[triangles_of(grid)]
    numbers = np.asarray(values, dtype=float)[triangles_of(grid)]
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
    offsets = np.stack(np.meshgrid(np.arange(size), np.arange(size)), axis=-1).reshape(-1, 2)
    pixels = first[:, None, :] + offsets
    a, b, c = np.moveaxis(corners, 1, 0)
    area = cross(b - a, c - a)
    flat = area == 0
    area = np.where(flat, 1.0, area)[:, None]
    weights = np.stack([cross(c[:, None] - b[:, None], pixels - b[:, None]),
                        cross(a[:, None] - c[:, None], pixels - c[:, None]),
                        cross(b[:, None] - a[:, None], pixels - a[:, None])], axis=-1) / area[..., None]
    height, width = picture.shape
    inside = ((weights >= -1e-9).all(axis=-1) & ~flat[:, None]
              & (pixels >= 0).all(axis=-1) & (pixels < (width, height)).all(axis=-1))
    x, y = np.moveaxis(pixels[inside], -1, 0)
    picture[y, x] = (weights * numbers[:, None, :]).sum(axis=-1)[inside]


def cross(a, b):
    """The third component of the cross product of vectors (..., 2)."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
