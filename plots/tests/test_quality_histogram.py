# SPDX-License-Identifier: GPL-3.0-or-later
"""The histogram of the quality command: what it shows, its kinds of file, bad arguments."""

import contextlib
import io
import json

from plots.figures import style
from plots.figures.quality_histogram import draw_quality_histogram, main
from plots.results.cell_types import counted
from plots.tests.test_read_results import InFolder

NUMBERS = {"title": "beam_$1.vtk", "n_invalid": 1, "q_min": 0.0, "q_mean": 0.625,
           "histogram": {"prism": [1, 0, 2, 1], "hexahedron": [0, 0, 1, 3], "pyramid": [0, 0, 0, 0]}}


class QualityHistogram(InFolder):
    def write(self, name):
        errors = io.StringIO()
        with contextlib.redirect_stderr(errors):
            code = main([str(self.folder / name)], io.StringIO(json.dumps(NUMBERS)))
        return code, errors.getvalue()

    def test_bars_hold_all_cells(self):
        style.apply_style()
        figure = draw_quality_histogram(NUMBERS)
        (axes,) = figure.axes
        self.assertEqual(sum(bar.get_height() for bar in axes.patches), 8)
        self.assertEqual([text.get_text() for text in axes.get_legend().get_texts()],
                         ["4 prisms", "4 hexahedra", r"$q_{\min} = 0.0000$",
                          r"$q_{\mathrm{mean}} = 0.6250$"])
        self.assertEqual(axes.get_xlabel(), "mean ratio $q$")
        self.assertEqual(axes.get_ylabel(), "number of cells")
        self.assertEqual(axes.get_title(), "beam_$1.vtk (1 invalid)")
        style.pyplot.close(figure)

    def test_every_kind_of_file_twice_the_same(self):
        for name, head in (("a.png", b"\x89PNG"), ("a.pdf", b"%PDF"), ("b/a.svg", b"<?xml")):
            contents = []
            for _ in range(2):
                self.assertEqual(self.write(name), (0, ""))
                contents.append((self.folder / name).read_bytes())
            self.assertTrue(contents[0].startswith(head))
            self.assertEqual(contents[0], contents[1])

    def test_bad_files(self):
        code, errors = self.write("a.bmp")
        self.assertEqual((code, errors.count("\n")), (2, 1))
        (self.folder / "file").write_text("")
        code, errors = self.write("file/a.png")
        self.assertEqual(code, 2)
        self.assertIn("cannot be written", errors)

    def test_counts_are_words(self):
        self.assertEqual(counted(1, "prism"), "1 prism")
        self.assertEqual(counted(10600, "hexahedron"), "10,600 hexahedra")
        self.assertEqual(counted(2, "quadrilateral"), "2 quadrilaterals")
