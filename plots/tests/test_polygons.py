# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables and figures of a polygon study, and how the kind of a study is found out."""

import contextlib
import io
import json
import math

import numpy as np

from plots.__main__ import main
from plots.figures import style
from plots.figures.domains import clearance, draw_domains
from plots.figures.polygon_study import FIGURES
from plots.figures.polygons import angle_text, draw_decomposition, draw_limits, draw_sequences
from plots.figures.side_ratios import draw_side_ratios
from plots.results.polygons import nodes_of, read_polygon_results
from plots.results.rows import groups_of
from plots.tables.formats import as_markdown, as_text
from plots.tables.latex import as_latex
from plots.tables.polygons import make_polygon_tables
from plots.tests.synthetic_polygons import write_polygon_results
from plots.tests.synthetic_results import change_provenance
from plots.tests.test_read_results import InFolder


class PolygonStudy(InFolder):
    def setUp(self):
        super().setUp()
        self.results_folder = write_polygon_results(self.folder / "r")

    def run_main(self, *options):
        output, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
            code = main([str(self.results_folder), *options])
        return code, output.getvalue(), errors.getvalue()

    def test_same_results_give_the_same_bytes(self):
        contents = []
        for _ in range(2):
            self.assertEqual(self.run_main("--quiet"), (0, "", ""))
            files = sorted(self.results_folder.glob("*s/*"))
            contents.append({path.name: path.read_bytes() for path in files})
        self.assertEqual(contents[0], contents[1])
        figures = {"_".join(filter(None, ("figure", number, name))) + suffix
                   for name, (number, _, _) in FIGURES.items() for suffix in (".pdf", ".png")}
        self.assertIn("figure_2_3_limits.pdf", figures)
        tables = {f"table_{name}{suffix}" for name in ("theorems", "classification")
                  for suffix in (".csv", ".md", ".tex")}
        self.assertEqual(set(contents[0]), figures | tables)

    def test_a_study_of_the_users_has_no_numbers_of_the_thesis(self):
        change_provenance(self.results_folder, built_in=False)
        self.assertEqual(self.run_main("--quiet", "--no-figures", "--only", "theorems"), (0, "", ""))
        self.assertEqual(self.run_main("--quiet", "--only", "limits,domains", "--format", "png"), (0, "", ""))
        self.assertEqual({path.name for path in self.results_folder.glob("*s/*")},
                         {"table_theorems.csv", "table_theorems.md", "table_theorems.tex", "limits.png", "domains.png"})

    def test_methods_and_columns_are_none_of_its(self):
        code, _, errors = self.run_main("--methods", "getme")
        self.assertEqual(code, 2)
        self.assertRegex(errors, r"^[^\n]*kind `polygons` has no methods[^\n]*\.\n$")

    def test_what_does_not_hold_is_seen(self):
        theorems, classification = make_polygon_tables(read_polygon_results(self.results_folder))
        for write in (as_text, as_markdown, as_latex):
            self.assertEqual(write(theorems).count("NO"), 1)
            self.assertEqual(write(theorems).count("Theorem 1"), 1)
        self.assertIn(r"x\_1 \| y & z", as_markdown(theorems))
        self.assertIn(r"x\_1 $|$ y \& z", as_latex(theorems))
        self.assertIn("| 3 | 2 | 0 | 0 |", as_markdown(classification))
        self.assertIn("| 4 | 2 | 1 | 1 |", as_markdown(classification))

    def test_kind_that_is_unknown_and_files_that_are_missing(self):
        (self.results_folder / "domains.csv").unlink()
        code, _, errors = self.run_main("--quiet")
        self.assertEqual(code, 2)
        self.assertIn("domains.csv: the file is missing", errors)
        (self.results_folder / "provenance.json").write_text(
            json.dumps({"parameters": {"kind": "other"}}))
        code, _, errors = self.run_main("--quiet")
        self.assertEqual(code, 2)
        self.assertIn("unknown kind `other`; known are smoothing, polygons", errors)
        self.assertEqual(errors.count("\n"), 1)


class PolygonFigures(InFolder):
    def setUp(self):
        super().setUp()
        self.results = read_polygon_results(write_polygon_results(self.folder / "r"))
        style.apply_style()
        self.addCleanup(style.pyplot.close, "all")

    def test_decomposition_has_a_panel_for_each_part(self):
        figure = draw_decomposition(self.results)
        titles = [axes.get_title() for axes in figure.axes]
        self.assertEqual(titles[:7], ["$z$"] + [f"$v_{{{k}}}$" for k in range(5)] + [""])
        self.assertEqual(titles[7:], ["$z$"] + [f"$v_{{{k}}}$" for k in range(6)])

    def test_sequences_have_a_row_for_each_pair_and_a_column_for_each_step(self):
        figure = draw_sequences(self.results, "combined", True)
        self.assertEqual(len(figure.axes), 2 * 3)
        words = [text.get_text() for axes in figure.axes for text in axes.texts]
        self.assertIn(r"\pi/4", words[1])
        widths = {round(float(np.ptp(axes.get_xlim())), 12) for axes in figure.axes}
        self.assertEqual(len(widths), 1, "the same scale")
        self.assertIsNone(draw_sequences(self.results, "nothing", True))

    def test_limits_stand_at_their_angles(self):
        figure = draw_limits(self.results)
        self.assertEqual(len(figure.axes), 2)
        ticks = [label.get_text() for label in figure.axes[1].get_xticklabels()]
        self.assertEqual(ticks, ["0", r"$\pi/22$"] + [rf"${k}\pi/22$" for k in (3, 5, 7, 9)]
                         + [r"$\pi/2$"])
        at = {text.get_text(): text.get_position()[0] for text in figure.axes[0].texts}
        self.assertAlmostEqual(at["$S_{1}$"] / at["$D_{1}$"], 0.4712 / 0.3)
        self.assertLess(at["$z$"], 0.0)

    def test_domains_show_their_grid_and_names(self):
        figure = draw_domains(self.results)
        left = figure.axes[0]
        self.assertEqual({text.get_text() for text in left.texts}, {"$D_{0}$", "$D_{1}$"})
        values = np.ma.getdata(left.collections[0].get_array()).reshape(6, 6)
        np.testing.assert_array_equal(values, np.tril(np.ones((6, 6)), -1).T)
        mask = np.ones((5, 5), dtype=bool)
        mask[0] = False
        self.assertEqual([clearance(mask, 3, 2), clearance(mask, 1, 2)], [2, 1])

    def test_bounds_are_drawn_for_every_second_step_and_lines_until_they_are_exact(self):
        axes = draw_side_ratios(self.results).axes[0]
        lengths = [len(line.get_xdata()) for line in axes.get_lines()]
        # The first transformation is exact after a step, where its line leaves the panel.
        self.assertEqual(lengths, [2, 1, 31, 16])
        exact = axes.get_lines()[0].get_ydata()
        self.assertTrue(0 < exact[1] < axes.get_ylim()[0])

    def test_angles_are_written_as_parts_of_pi(self):
        for theta, text in ((math.pi / 3, r"\pi/3"), (7 * math.pi / 16, r"7\pi/16"), (0.1, "0.100")):
            self.assertEqual(angle_text(theta), text)

    def test_rows_of_nodes_in_any_order_give_the_same_polygon(self):
        (_, first), *_ = groups_of(self.results.limits, "n", "theta")
        backwards = type(first)(first.path, {k: v[::-1] for k, v in first.columns.items()})
        np.testing.assert_array_equal(nodes_of(first), nodes_of(backwards))
