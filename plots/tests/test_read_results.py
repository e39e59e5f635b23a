# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading of CSV and VTU files, and what is said about broken ones."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import numpy as np

from plots.__main__ import main
from plots.figures.planar_geometry import boundary_loops, triangles_of
from plots.results.rows import ResultsError
from plots.results.smoothing import read_results
from plots.results.vtu import read_vtu
from plots.tests.synthetic_results import write_csv, write_results, write_vtu


class InFolder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)


class ReadVtu(InFolder):
    def test_ascii_and_base64_hold_the_same_grid(self):
        for layout in ("ascii", "binary"):
            write_vtu(self.folder / "mesh.vtu", layout)
            grid = read_vtu(self.folder / "mesh.vtu")
            self.assertEqual([len(cell) for cell in grid.cells()], [4, 5, 3])
            self.assertEqual(grid.points.shape, (8, 3))
            np.testing.assert_array_equal(grid.cell_data["mean_ratio"], [1.0, 0.5, 0.9])
            np.testing.assert_array_equal(grid.point_data["exact_solution"],
                                          grid.points[:, 0] * grid.points[:, 1])
            self.assertTrue(grid.is_planar)

    def test_boundary_and_triangles_of_polygons(self):
        write_vtu(self.folder / "mesh.vtu")
        grid = read_vtu(self.folder / "mesh.vtu")
        self.assertEqual(boundary_loops(grid), [[0, 1, 4, 5, 6, 2, 7, 3]])
        a, b, c = (grid.points[column, :2] for column in triangles_of(grid).T)
        areas = 0.5 * np.cross(b - a, c - a)
        self.assertTrue((areas > 0).all())
        self.assertAlmostEqual(areas.sum(), 1.0 + 1.5 + 0.4)

    def test_truncated_file(self):
        path = self.folder / "mesh.vtu"
        write_vtu(path)
        whole = path.read_text()
        for text in (whole[:len(whole) // 2], whole.replace('NumberOfPoints="8"', 'NumberOfPoints="9"'),
                     whole.replace('format="binary"', 'format="appended"'), "<a/>"):
            path.write_text(text)
            with self.assertRaises(ResultsError):
                read_vtu(path)


class ReadResults(InFolder):
    def message_of(self, folder):
        """The message on stderr of a run that must end with exit code 2."""
        errors = io.StringIO()
        with contextlib.redirect_stderr(errors):
            self.assertEqual(main([str(folder), "--quiet", "--no-figures"]), 2)
        return errors.getvalue()

    def test_orders_and_titles(self):
        results = read_results(write_results(self.folder / "r", methods=("own", "getme")))
        self.assertEqual(results.methods, ("getme", "own"))  # the provenance knows getme only
        self.assertEqual(results.degrees, ("1", "2"))
        self.assertEqual(results.title("getme"), "GETMe")
        self.assertEqual(results.title("own"), "own")

    def test_order_of_columns_does_not_matter(self):
        folder = write_results(self.folder / "r")
        before = read_results(folder).summary.records()
        write_csv(folder / "summary.csv", sorted(before[0]), before)
        self.assertEqual(read_results(folder).summary.records(), before)

    def test_files_that_may_be_absent(self):
        folder = write_results(self.folder / "r")
        (folder / "thresholds.csv").unlink()
        (folder / "provenance.json").unlink()
        results = read_results(folder)
        self.assertEqual((results.study, len(results.thresholds)), ("gear", 0))

    def test_missing_file_and_folder(self):
        folder = write_results(self.folder / "r")
        (folder / "summary.csv").unlink()
        self.assertIn("summary.csv: the file is missing", self.message_of(folder))
        self.assertIn("no such folder", self.message_of(self.folder / "nowhere"))

    def test_broken_files(self):
        for name, old, new, said in (
                ("iterations.csv", "e_mean", "e_other", "column `e_mean` is missing"),
                ("summary.csv", "377.4", "many", "not a number"),
                ("provenance.json", "}", "", "not a complete JSON file")):
            folder = write_results(self.folder / name)
            path = folder / name
            path.write_text(path.read_text().replace(old, new))
            message = self.message_of(folder)
            self.assertIn(said, message)
            self.assertEqual(message.count("\n"), 1)

    def test_truncated_row(self):
        folder = write_results(self.folder / "r")
        path = folder / "iterations.csv"
        path.write_text(path.read_text()[:-40])
        self.assertIn("truncated", self.message_of(folder))
