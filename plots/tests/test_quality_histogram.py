# SPDX-License-Identifier: GPL-3.0-or-later
"""Histograms of one mesh: what they show, their kinds of file, bad arguments."""

import contextlib
import io

from plots.__main__ import main
from plots.figures import style
from plots.figures.quality_histogram import draw_quality_histogram
from plots.results.cell_types import counted
from plots.results.quality_histogram import read_quality_histogram
from plots.results.rows import ResultsError
from plots.tests.test_read_results import InFolder

TITLE = "beam_$1.vtk"
COUNTS = {"prism": [1, 0, 2, 1], "hexahedron": [0, 0, 1, 3], "pyramid": [0, 0, 0, 0]}
TYPED = "lower,upper,count,cell_type\n" + "".join(
    f"{b / 4},{(b + 1) / 4},{count},{name}\n" for name, counts in COUNTS.items()
    for b, count in enumerate(counts))
OPTIONS = ("--title", TITLE, "--q-min", "0", "--q-mean", "0.625", "--n-invalid", "1")


class QualityHistogram(InFolder):
    def run_main(self, text, name, *options):
        """The text is the content of the CSV file."""
        (self.folder / "counts.csv").write_text(text)
        errors = io.StringIO()
        with contextlib.redirect_stderr(errors):
            code = main(["histogram", str(self.folder / "counts.csv"), str(self.folder / name), *options])
        return code, errors.getvalue()

    def test_bars_hold_all_cells(self):
        style.apply_style()
        (self.folder / "counts.csv").write_text(TYPED)
        figure = draw_quality_histogram(read_quality_histogram(self.folder / "counts.csv", TITLE, 0, 0.625, 1))
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
                self.assertEqual(self.run_main(TYPED, name, *OPTIONS), (0, ""))
                contents.append((self.folder / name).read_bytes())
            self.assertTrue(contents[0].startswith(head))
            self.assertEqual(contents[0], contents[1])

    def test_counts_without_types_in_any_order_of_rows(self):
        self.assertEqual(self.run_main("count,upper,lower\n7,1,0.25\n2,0.25,0\n", "a.svg"), (0, ""))
        histogram = read_quality_histogram(self.folder / "counts.csv", "own")
        self.assertEqual({name: list(counts) for name, counts in histogram.counts.items()}, {"cell": [2, 7]})
        figure = draw_quality_histogram(histogram)
        (axes,) = figure.axes
        self.assertEqual([(bar.get_x(), bar.get_width(), bar.get_height()) for bar in axes.patches],
                         [(0, 0.25, 2), (0.25, 0.75, 7)])
        self.assertEqual([text.get_text() for text in axes.get_legend().get_texts()], ["9 cells"])
        self.assertEqual((axes.get_title(), axes.get_xlim()), ("own", (0, 1)))
        style.pyplot.close(figure)
        self.assertIn("counts.csv", (self.folder / "a.svg").read_text())  # the title if none is given

    def test_bins_that_are_none(self):
        head = "lower,upper,count,cell_type\n"
        for text, said in (
                ("lower,upper\n0,1\n", "column `count` is missing"), ("", "empty"),
                (head + "0,1,,\n", "empty or infinite"), (head + "0,1,many,\n", "not a number"),
                (head + "1,1,2,\n", "not above"), (head + "0,1,2.5,\n", "not a number of cells"),
                (head + "0,1,-2,\n", "not a number of cells"), (head + "0,1,0,\n", "counts no cell"),
                (head, "counts no cell"), (head + "0,0.6,1,\n0.5,1,1,\n", "overlap"),
                (head + "0,1,1,prism\n0,1,1,prism\n", "a bin twice"),
                (head + "0,1,1,wedge\n", "unknown cell type `wedge`; known are triangle")):
            code, errors = self.run_main(text, "a.png")
            self.assertEqual((code, errors.count("\n")), (2, 1), text)
            self.assertIn("counts.csv: ", errors)
            self.assertIn(said, errors)
            self.assertFalse((self.folder / "a.png").exists())

    def test_paths_that_cannot_be_used(self):
        code, errors = self.run_main(TYPED, "a.bmp")
        self.assertEqual((code, errors.count("\n")), (2, 1))
        self.assertIn("a.bmp: a figure ends with .pdf, .png or .svg", errors)
        (self.folder / "file").write_text("")
        code, errors = self.run_main(TYPED, "file/a.png")
        self.assertEqual((code, errors.count("\n")), (2, 1))
        self.assertIn("cannot be written", errors)
        with self.assertRaisesRegex(ResultsError, "missing"):
            read_quality_histogram(self.folder / "nowhere.csv", "")

    def test_counts_are_words(self):
        self.assertEqual(counted(1, "prism"), "1 prism")
        self.assertEqual(counted(10600, "hexahedron"), "10,600 hexahedra")
        self.assertEqual(counted(2, "quadrilateral"), "2 quadrilaterals")
