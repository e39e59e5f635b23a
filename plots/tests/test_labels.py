# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes whose files also have the labelled points, edges and facets: they are drawn without them."""

import contextlib
import io
from pathlib import Path
from unittest import mock

import numpy as np

from plots.__main__ import main
from plots.figures.grids import read_grids
from plots.figures.virtual_display import NoDisplay
from plots.results.smoothing import read_results
from plots.results.vtu import read_vtu
from plots.tests.synthetic_results import data_array, write_results
from plots.tests.synthetic_volume import box
from plots.tests.test_read_results import InFolder

VERTEX, EDGE, QUADRILATERAL, HEXAHEDRON = 1, 3, 9, 12
POINTS = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]], dtype=float)
SQUARES = ([0, 1, 4, 3], [1, 2, 5, 4])


def write_labelled(path, points, cells):
    """Writes a mesh of (type of VTK, nodes) in this order; the mean ratio is 0 for cells that are not cells of a
    mesh."""
    top = max(kind for kind, _ in cells)
    ratios = np.array([0.5 + 0.1 * i if kind == top else 0.0 for i, (kind, _) in enumerate(cells)])
    nodes = [np.asarray(nodes) for _, nodes in cells]
    parts = {
        "PointData": [data_array("exact_solution", points[:, 0] + points[:, 1], "ascii")],
        "CellData": [data_array("mean_ratio", ratios, "ascii"),
                     data_array("label", np.arange(len(cells)), "ascii")],
        "Points": [data_array("Points", points, "ascii", 3)],
        "Cells": [data_array("connectivity", np.concatenate(nodes), "ascii"),
                  data_array("offsets", np.cumsum([len(n) for n in nodes]), "ascii"),
                  data_array("types", np.array([kind for kind, _ in cells], dtype=np.uint8), "ascii")]}
    body = "".join(f"<{name}>{''.join(arrays)}</{name}>" for name, arrays in parts.items())
    Path(path).write_text(
        '<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">'
        f'<UnstructuredGrid><Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">{body}'
        '</Piece></UnstructuredGrid></VTKFile>')


def planar_cells():
    return [(EDGE, [0, 1]), (QUADRILATERAL, SQUARES[0]), (EDGE, [1, 2]), (QUADRILATERAL, SQUARES[1]), (VERTEX, [0])]


class Labels(InFolder):
    def read(self, points, cells):
        write_labelled(self.folder / "m.vtu", points, cells)
        return read_vtu(self.folder / "m.vtu")

    def test_planar(self):
        grid = self.read(POINTS, planar_cells())
        self.assertTrue(grid.is_planar)
        self.assertEqual([list(cell) for cell in grid.cells()], list(SQUARES))
        np.testing.assert_allclose(grid.cell_data["mean_ratio"], [0.6, 0.8])
        np.testing.assert_array_equal(grid.cell_data["label"], [1, 3])

    def test_surface_with_feature_lines(self):
        bent = POINTS + np.outer([0, 1, 0, 0, 1, 0], (0, 0, 0.5))
        grid = self.read(bent, planar_cells())
        self.assertTrue(grid.is_surface)
        self.assertEqual(len(grid.types), 2)

    def test_volume_with_facets_and_edges(self):
        points, cells = box("hex")
        grid = self.read(points, [(QUADRILATERAL, cells[0][:4]), (EDGE, cells[0][:2]),
                                  *((HEXAHEDRON, cell) for cell in cells)])
        self.assertTrue(grid.is_volume)
        np.testing.assert_array_equal(grid.connectivity.reshape(-1, 8), cells)
        self.assertGreater(grid.cell_data["mean_ratio"].min(), 0.5)

    def test_cells_of_other_kinds_are_no_labels(self):
        lagrange_triangle = (69, [0, 1, 4, 3, 2, 5])
        grid = self.read(POINTS, [(QUADRILATERAL, SQUARES[0]), lagrange_triangle])
        self.assertFalse(grid.is_planar or grid.is_surface or grid.is_volume)

    def test_they_are_drawn(self):
        folder = write_results(self.folder / "r")
        for path in (folder / "meshes").iterdir():
            write_labelled(path, POINTS, planar_cells())
        planar, _, _ = read_grids(read_results(folder), self.fail)
        self.assertEqual(len(planar), 3)
        errors = io.StringIO()
        with contextlib.redirect_stderr(errors), mock.patch("plots.figures.style.DPI", 40), \
                mock.patch("plots.figures.render.virtual_display", side_effect=NoDisplay):
            self.assertEqual(main([str(folder), "--quiet", "--format", "png"]), 0)
        self.assertEqual(errors.getvalue(), "")
        names = {path.stem for path in folder.glob("figures/*")}
        self.assertLessEqual({"figure_6_2_model", "figure_6_3_meshes", "figure_6_3_meshes_full",
                              "figure_histograms"}, names)
