# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading of meshes by VTK, and messages about broken files."""

import contextlib
import io
import os
import sys
from unittest import mock

import numpy as np

from plots.__main__ import main
from plots.figures.planar_geometry import boundary_loops, triangles_of
from plots.results.rows import ResultsError
from plots.results.vtu import NoVtk, read_vtu
from plots.tests.synthetic_results import write_results, write_vtu
from plots.tests.test_read_results import InFolder


@contextlib.contextmanager
def standard_error_in(path):
    """Everything that is written to the standard error stream, also by C++, goes to a file."""
    before = os.dup(2)
    with open(path, "wb") as stream:
        os.dup2(stream.fileno(), 2)
    try:
        yield
    finally:
        os.dup2(before, 2)
        os.close(before)


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

    def broken_files(self):
        """Contents of files that are truncated, or foreign."""
        path = self.folder / "whole.vtu"
        write_vtu(path, "ascii")
        text = path.read_text()
        write_vtu(path)
        whole = path.read_text()
        return (whole[:len(whole) // 2], whole.replace('NumberOfPoints="8"', 'NumberOfPoints="9"'),
                whole.replace('format="binary"', 'format="appended"'), "<a/>", whole[:-20], "", "a,b\n1,2\n",
                whole.replace('NumberOfCells="3"', 'NumberOfCells="4"'),
                whole.replace("UnstructuredGrid", "PolyData"), whole.replace("Cells>", "Other>"),
                whole.replace('"connectivity"', '"other"'), text.replace("0 1 2 3 1 4", "0 1 2 3 1 8"),
                text.replace("4 9 12", "4 9 13"), text.replace("0.5", "half"), "\0\1")

    def test_broken_files_are_one_sentence(self):
        path, written = self.folder / "mesh.vtu", self.folder / "stderr"
        for number, text in enumerate(self.broken_files()):
            path.write_text(text)
            with standard_error_in(written), self.assertRaises(ResultsError, msg=number) as raised:
                read_vtu(path)
            self.assertRegex(str(raised.exception), r"^.*mesh\.vtu: not a complete VTU file[^\n]*\.$")
            self.assertEqual(written.read_text(), "", number)

    def test_missing_file(self):
        for path in (self.folder / "nowhere.vtu", self.folder):
            with self.assertRaisesRegex(ResultsError, "the file is missing"):
                read_vtu(path)

    def test_without_vtk_the_figures_without_meshes_are_made(self):
        folder = write_results(self.folder / "r")
        errors = io.StringIO()
        with mock.patch.dict(sys.modules, {"vtkmodules.vtkIOXML": None}):
            with self.assertRaisesRegex(NoVtk, "python3-vtk9"):
                read_vtu(folder / "meshes" / "tri_initial.vtu")
            with contextlib.redirect_stderr(errors):
                self.assertEqual(main([str(folder), "--quiet", "--format", "png"]), 0)
        self.assertRegex(errors.getvalue(), r"^No pictures of meshes: [^\n]*python3-vtk9\.\n$")
        names = {path.stem for path in folder.glob("figures/*.png")}
        self.assertIn("figure_6_4_history", names)
        self.assertNotIn("figure_6_3_meshes", names)
