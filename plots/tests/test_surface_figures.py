# SPDX-License-Identifier: GPL-3.0-or-later
"""The figure of surface meshes: what it shows."""

import unittest

import numpy as np

from plots.figures import style
from plots.figures.render import render
from plots.figures.surfaces import DIRECTION, draw_surfaces, surface_scene
from plots.figures.volume_geometry import view_of
from plots.results.vtu import UnstructuredGrid
from plots.tests.rendering import needs_rendering


class Surfaces(unittest.TestCase):
    def grid(self, height, quality=(0.1, 0.95)):
        """Two squares next to each other, bent by `height`."""
        points = np.array([[0, 0, 0], [1, 0, height], [2, 0, 0], [0, 1, 0], [1, 1, height], [2, 1, 0]],
                          dtype=float)
        return UnstructuredGrid(points=points, connectivity=np.array([0, 1, 4, 3, 1, 2, 5, 4]),
                                offsets=np.array([0, 4, 8]), types=np.array([9, 9], dtype=np.uint8),
                                point_data={}, cell_data={"mean_ratio": np.array(quality)})

    def test_points_distinguish_a_surface_from_a_planar_mesh(self):
        flat, bent = self.grid(0.0), self.grid(0.5)
        self.assertTrue(flat.is_planar and not flat.is_surface)
        self.assertTrue(bent.is_surface and not bent.is_planar and not bent.is_volume)

    @needs_rendering
    def test_shows_every_cell_in_its_colour(self):
        grid = self.grid(0.5)
        view = view_of(grid.points, DIRECTION)
        picture, = render([surface_scene(grid, view, (200, 120))])
        seen = picture[(picture != 255).any(axis=2)]
        self.assertGreater(len(seen), 4000)
        # The better cell, on the right, is another colour than the worse one.
        left, right = (picture[:, part][(picture[:, part] != 255).any(axis=2)].mean(axis=0)
                       for part in (slice(0, 80), slice(120, 200)))
        self.assertGreater(np.abs(left - right).max(), 40)

    @needs_rendering
    def test_has_a_panel_for_each_method(self):
        style.apply_style()
        grid = self.grid(0.5)
        figure = draw_surfaces([("Quad", [("Initial", grid), ("GETMe", grid)])])
        self.assertEqual(sum(len(axes.images) for axes in figure.axes), 2)
