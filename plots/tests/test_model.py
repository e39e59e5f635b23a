# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact solution on the model: its colours are those of the colour map. And details of narrow
domains."""

import unittest

import numpy as np
from matplotlib import colormaps

from plots.figures import style
from plots.figures.model import draw_model
from plots.figures.planar_geometry import areas, centroids, window_of
from plots.figures.render import Scene, render
from plots.figures.resample import resampled
from plots.figures.volume_geometry import view_of
from plots.results.vtu import UnstructuredGrid
from plots.tests.rendering import needs_rendering
from plots.tests.synthetic_volume import box


def grid_of(points, cells, values=None):
    """A planar mesh of cells with so many nodes each; values at the nodes."""
    cells = np.asarray(cells)
    return UnstructuredGrid(
        points=np.column_stack([points, np.zeros(len(points))]), connectivity=cells.ravel(),
        offsets=cells.shape[1] * np.arange(len(cells) + 1),
        types=np.full(len(cells), 5 if cells.shape[1] == 3 else 9),
        point_data={"exact_solution": np.asarray(values)}, cell_data={"mean_ratio": np.ones(len(cells))})


def rectangle(n_x, n_y, width, height):
    """Points and quadrilaterals."""
    x, y = np.meshgrid(np.linspace(0, width, n_x + 1), np.linspace(0, height, n_y + 1))
    first = (np.arange(n_y)[:, None] * (n_x + 1) + np.arange(n_x)).ravel()
    return (np.column_stack([x.ravel(), y.ravel()]),
            np.column_stack([first, first + 1, first + n_x + 2, first + n_x + 1]))


def distance_to_map(pixels):
    """Distances of colours (n, 3), from 0 to 255, from the nearest colour of the colour map."""
    colours = colormaps[style.SOLUTION_MAP](np.arange(256))[:, :3] * 255
    return np.array([np.abs(colours - pixel).max(axis=1).min() for pixel in pixels])


class Model(unittest.TestCase):
    def test_colours_are_those_of_the_map(self):
        # One triangle from the least to the largest value: mixed colours would be far off the map.
        grid = grid_of([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)], [0.0, 1.0, 0.0])
        style.apply_style()
        figure = draw_model(grid)
        self.addCleanup(style.pyplot.close, figure)
        figure.canvas.draw()
        shown = np.asarray(figure.canvas.buffer_rgba())[::-1, :, :3].astype(float)
        axes = figure.axes[1]
        inside = [axes.transData.transform((x, 0.2)) for x in np.linspace(0.1, 0.7, 40)]
        pixels = np.array([shown[int(y), int(x)] for x, y in inside])
        self.assertLess(distance_to_map(pixels).max(), 6)
        expected = colormaps[style.SOLUTION_MAP](np.linspace(0.1, 0.7, 40))[:, :3] * 255
        self.assertLess(np.abs(pixels - expected).max(), 12)

    def test_values_are_linear_on_triangles(self):
        points, cells = rectangle(7, 5, 3.0, 2.0)
        inner = ((points > 0) & (points < (3, 2))).all(axis=1)
        points[inner] += np.random.default_rng(1).uniform(-0.1, 0.1, (inner.sum(), 2))
        picture = resampled(grid_of(points, cells), 2 * points[:, 0] - points[:, 1], 300)
        self.assertEqual(picture.shape, (200, 300))
        y, x = (np.indices(picture.shape) + 0.5) / 100
        np.testing.assert_allclose(picture, 2 * x - y, atol=1e-9)

    def test_holes_stay_empty_but_for_their_border(self):
        points, cells = rectangle(10, 10, 1.0, 1.0)
        middle = centroids(grid_of(points, cells))
        hole = (np.abs(middle - 0.5) < 0.2).all(axis=1)
        picture = resampled(grid_of(points, cells[~hole]), np.ones(len(points)), 100)
        empty = np.isnan(picture)
        self.assertEqual((empty.sum(), empty[31:69, 31:69].all()), (38 * 38, True))

    def test_cells_without_area_leave_no_trace(self):
        grid = grid_of([(0, 0), (1, 0), (0, 1), (0.5, 0.5)], [(0, 1, 2), (1, 3, 3)], [0.0, 1.0, 2.0, 9.0])
        picture = resampled(grid, grid.point_data["exact_solution"], 50)
        self.assertLess(np.nanmax(picture), 2.0)

    @needs_rendering
    def test_colours_on_solids_are_those_of_the_map(self):
        points, cells = box("hex", (1, 1, 1))
        grid = UnstructuredGrid(points=points, connectivity=cells.ravel(), offsets=np.array([0, 8]),
                                types=np.array([12]), point_data={}, cell_data={})
        colours = colormaps[style.SOLUTION_MAP](np.arange(256), bytes=True)[:, :3]
        picture, = render([Scene(grid, view_of(points, (0, -1, 0), margin=0), (60, 60), ambient=1.0,
                                 point_values=points[:, 0], value_colours=colours)])
        self.assertLess(distance_to_map(picture[30].astype(float)).max(), 3)
        self.assertGreater(np.ptp(picture[30, :, 0].astype(int)), 150)


class Windows(unittest.TestCase):
    def filled(self, grid, window):
        """The part of a window that cells fill."""
        low, high = np.reshape(window, (2, 2))
        inside = ((centroids(grid) > low) & (centroids(grid) < high)).all(axis=1)
        return areas(grid)[inside].sum() / np.prod(high - low)

    def test_a_window_that_is_filled_stays_where_it_is_wanted(self):
        grid = grid_of(*rectangle(40, 40, 2.0, 2.0))
        np.testing.assert_allclose(window_of(grid, (0.6, 0.5), 0.3, 1.5), (0.9, 0.8, 1.5, 1.2))

    def test_details_of_narrow_domains_are_filled(self):
        for size in ((10.0, 0.4), (0.4, 10.0)):
            grid = grid_of(*rectangle(*(max(4, int(10 * s)) for s in size), *size))
            window = window_of(grid, (0.83, 0.62), 0.33, 1.3)
            self.assertGreater(self.filled(grid, window), 0.3)
        # Wide enough for half of the window, if it is moved.
        grid = grid_of(*rectangle(60, 14, 6.0, 1.4))
        window = window_of(grid, (0.83, 0.9), 0.33, 1.3)
        self.assertGreaterEqual(self.filled(grid, window), 0.5)
        self.assertAlmostEqual(window[2] - window[0], 0.33 * 6)

    def test_a_window_in_a_hole_moves_to_its_border(self):
        points, cells = rectangle(40, 40, 2.0, 2.0)
        middle = centroids(grid_of(points, cells))
        grid = grid_of(points, cells[(np.abs(middle - 1) > 0.5).any(axis=1)])
        window = window_of(grid, (0.5, 0.5), 0.2, 1.0)
        self.assertGreaterEqual(self.filled(grid, window), 0.5)
