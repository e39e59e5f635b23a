# SPDX-License-Identifier: GPL-3.0-or-later
"""Sections of volume meshes by planes: areas from formulas, and the same plane through other cells."""

import unittest

import numpy as np

from plots.figures.section_geometry import section
from plots.figures.volume_geometry import Cut
from plots.results.vtu import UnstructuredGrid
from plots.tests.synthetic_volume import VTK_TYPES, box


def grid_of(points, cells, kind):
    """A grid of cells of one of VTK's types."""
    cells = np.asarray(cells)
    return UnstructuredGrid(points=np.asarray(points, dtype=float), connectivity=cells.ravel(),
                            offsets=cells.shape[1] * np.arange(len(cells) + 1),
                            types=np.full(len(cells), kind), point_data={}, cell_data={})


def area(polygon):
    """By the shoelace formula; positive if counterclockwise."""
    x, y = polygon.T
    return 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))


def areas(grid, origin, normal):
    polygons, cells = section(grid, Cut(origin, normal))
    np.testing.assert_array_equal(np.sort(cells), np.unique(cells))
    return [area(polygon) for polygon in polygons]


class Section(unittest.TestCase):
    def test_sections_of_a_box_fill_the_plane(self):
        meshes = [grid_of(*box(kind), VTK_TYPES[kind]) for kind in ("tet", "hex")]  # 4 x 2 x 3
        # Between nodes, through a layer of nodes, and across an edge of the box.
        for origin, normal, expected in (((1.2, 0, 0), (1, 0, 0), 6.0), ((0, 1, 0), (0, -1, 0), 12.0),
                                         ((1.5, 0, 0), (1, 1, 0), 1.5 * np.sqrt(2) * 3)):
            for mesh in meshes:
                found = areas(mesh, origin, normal)
                self.assertAlmostEqual(sum(found), expected)
                self.assertGreaterEqual(min(found), -1e-12)
        self.assertEqual(len(areas(meshes[1], (0, 1, 0), (0, -1, 0))), 12)

    def test_moved_nodes_leave_no_gaps(self):
        points, cells = box("tet")
        inner = ((points > 0) & (points < (4, 2, 3))).all(axis=1)
        points[inner] += np.random.default_rng(1).uniform(-0.15, 0.15, (inner.sum(), 3))
        found = areas(grid_of(points, cells, VTK_TYPES["tet"]), (2, 1, 1.4), (0, 0, 1))
        self.assertAlmostEqual(sum(found), 8.0)
        self.assertGreaterEqual(min(found), -1e-12)

    def test_prism_and_pyramid(self):
        prism = grid_of([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)],
                        [range(6)], 13)
        pyramid = grid_of([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)], [range(5)], 14)
        for mesh, origin, normal, expected in ((prism, (0, 0, 0.5), (0, 0, 1), 0.5),
                                               (prism, (0.25, 0, 0), (1, 0, 0), 0.75),
                                               (pyramid, (0, 0, 0.5), (0, 0, 1), 0.25),
                                               (pyramid, (0.5, 0, 0), (1, 0, 0), 0.5)):
            np.testing.assert_allclose(areas(mesh, origin, normal), [expected])

    def test_a_plane_outside_cuts_nothing(self):
        polygons, cells = section(grid_of(*box("hex"), 12), Cut((5, 0, 0), (1, 0, 0)))
        self.assertEqual((polygons, len(cells)), ([], 0))
