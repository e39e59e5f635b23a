# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry for drawing volume meshes: where to look from, and where to cut."""

from dataclasses import dataclass, replace

import numpy as np

# From the viewer's front, some degrees from the right and from above: three sides of a box are seen.
MODEL_DIRECTION = (-0.55, -1.0, 0.75)
# Seen from the removed side, slightly from the right and from above.
CUT_TILT = (0.28, 0.42)
LARGEST_DETAIL = 0.5  # of a view's shorter side: a detail of a small mesh is to be one, too


@dataclass(frozen=True)
class View:
    """A rectangle in space that fills a picture, seen in parallel projection."""

    centre: tuple
    towards: tuple  # unit vector from the solid to the viewer
    up: tuple  # unit vector that points upwards in the picture
    width: float  # in units of the mesh
    height: float
    distance: float  # of the viewer, beyond everything

    def zoomed(self, centre, width, aspect):
        """The part around a point in space; `width` in units of the mesh, `aspect` width / height."""
        return replace(self, centre=tuple(centre), width=width, height=width / aspect)

    def fitted(self, aspect):
        """Returns this view with a margin on two sides, so that width / height is `aspect`."""
        return replace(self, width=max(self.width, self.height * aspect),
                       height=max(self.height, self.width / aspect))

    def flattened(self, points):
        """Projects points in space (n, 3) into the picture, shape (n, 2), in units of the mesh."""
        right = np.cross(self.up, self.towards)
        return np.asarray(points) @ np.column_stack([right, self.up])


def unit(vector):
    """The vector with length 1."""
    vector = np.asarray(vector, dtype=float)
    return vector / np.linalg.norm(vector)


def upwards(towards):
    """Upwards in the picture: as near to z as the direction of view allows, or to y if that is z."""
    for axis in ((0, 0, 1), (0, 1, 0)):
        rest = np.asarray(axis, dtype=float) - np.dot(axis, towards) * towards
        if np.linalg.norm(rest) > 1e-3:
            return unit(rest)
    raise AssertionError("no direction is parallel to two axes")


def view_of(points, direction, margin=0.02):
    """The view from a direction that holds all points, shape (n, 3)."""
    towards = unit(direction)
    up = upwards(towards)
    right = np.cross(up, towards)
    coordinates = points @ np.column_stack([right, up, towards])
    low, high = coordinates.min(axis=0), coordinates.max(axis=0)
    middle = 0.5 * (low + high)
    width, height, depth = high - low
    margins = 2 * margin * max(width, height)
    return View(tuple(middle[0] * right + middle[1] * up + middle[2] * towards), tuple(towards),
                tuple(up), width + margins, height + margins, 2 * (width + height + depth))


def cell_centres(grid):
    """The mean of each cell's nodes, shape (n_cells, 3)."""
    sums = np.add.reduceat(grid.points[grid.connectivity], grid.offsets[:-1], axis=0)
    return sums / np.diff(grid.offsets)[:, None]


@dataclass(frozen=True)
class Cut:
    """A plane; what lies on the side to which the normal points is taken away."""

    origin: tuple
    normal: tuple

    def kept(self, grid):
        """A mask of the cells that stay, shape (n_cells,): whole ones, so that the cut shows their faces."""
        return (cell_centres(grid) - self.origin) @ unit(self.normal) <= 0

    def crossed(self, grid):
        """A mask of the cells that the plane crosses, shape (n_cells,). If it runs between cells: the cells that it
        bounds on one side."""
        heights = ((grid.points - self.origin) @ unit(self.normal))[grid.connectivity]
        low = np.minimum.reduceat(heights, grid.offsets[:-1])
        high = np.maximum.reduceat(heights, grid.offsets[:-1])
        return (low <= 0) & (high > 0)

    def edge_lengths(self, grid):
        """The length of an edge of each cell at the cut."""
        chosen = np.flatnonzero(self.crossed(grid))
        starts = grid.connectivity[grid.offsets[chosen]]
        ends = grid.connectivity[grid.offsets[chosen] + 1]
        return np.linalg.norm(grid.points[ends] - grid.points[starts], axis=1)

    def spacing(self, grid):
        """A typical distance between neighbouring nodes near the cut."""
        return float(np.median(self.edge_lengths(grid)))

    def seen_spacing(self, grid):
        """The length of edges that cells on nine tenths of the cut's area exceed: in pictures of graded meshes a few
        large cells cover most of the area."""
        lengths = np.sort(self.edge_lengths(grid))
        fractions = np.cumsum(lengths**2) / np.sum(lengths**2)
        return float(lengths[np.searchsorted(fractions, 0.1)])

    def densest_window(self, grid, view, cells_across):
        """(centre, width) of the window of so many cells that holds most of the cells that are cut,
        moved to the middle of these, lest half of it is empty."""
        # On graded meshes neither the many small cells nor the large ones alone say how much to show.
        cell = np.sqrt(self.spacing(grid) * self.seen_spacing(grid))
        width = min(cells_across * cell, LARGEST_DETAIL * min(view.width, view.height))
        middles = cell_centres(grid)[self.crossed(grid)]
        flat = view.flattened(middles)
        # Some hundreds of candidates are enough to find an area that is filled.
        candidates = np.arange(0, len(flat), max(1, len(flat) // 400))
        inside = [(np.abs(flat - flat[i]) < 0.5 * width).all(axis=1) for i in candidates]
        return middles[max(inside, key=np.count_nonzero)].mean(axis=0), width

    def view(self, grid):
        """A view of the cut from the side that is taken away."""
        normal = unit(self.normal)
        up = upwards(normal)
        right = np.cross(up, normal)
        chosen = np.repeat(self.kept(grid), np.diff(grid.offsets))
        direction = normal + CUT_TILT[0] * right + CUT_TILT[1] * up
        return view_of(grid.points[np.unique(grid.connectivity[chosen])], direction)


def widest_cut(grid):
    """Returns, of the planes through the middle of the bounding box across x, y and z, the one that crosses most cells;
    normals point to where the views of the model come from."""
    origin = 0.5 * (grid.points.min(axis=0) + grid.points.max(axis=0))
    cuts = [Cut(tuple(origin), normal) for normal in ((0, -1, 0), (-1, 0, 0), (0, 0, 1))]
    return max(cuts, key=lambda cut: np.count_nonzero(cut.crossed(grid)))


def same_box(grid, other, tolerance=0.01):
    """True if the bounding boxes of two grids are almost equal: meshes of the same solid."""
    boxes = [np.array([g.points.min(axis=0), g.points.max(axis=0)]) for g in (grid, other)]
    size = np.max(boxes[0][1] - boxes[0][0])
    return bool(np.abs(boxes[0] - boxes[1]).max() <= tolerance * size)
