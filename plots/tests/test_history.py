# SPDX-License-Identifier: GPL-3.0-or-later
"""Content of histories: where methods become invalid, which record is the result, and their axes."""

import itertools

import numpy as np

from plots.figures import style
from plots.figures.history import draw_history
from plots.figures.history_lines import Line, dominant_method, panel_lines, range_of
from plots.results.smoothing import read_results
from plots.tests.synthetic_results import SUMMARY, COLUMNS, results_row, write_csv
from plots.tests.test_read_results import InFolder


def write_history(folder, methods):
    """A folder of one mesh; `methods` maps (mesh, method) to (seconds, lowest qualities, numbers of
    invalid cells, which record is the result)."""
    folder.mkdir()
    rows, summary = [], []
    for (mesh, method), (seconds, qualities, n_invalid, result) in methods.items():
        keys = {"study": "own", "mesh": mesh, "method": method, "degree": "1"}
        found = [results_row(**keys, iteration=i, smoothing_seconds=t, q_min=q, q_star_min=q, q_mean=q,
                             n_invalid=n, e_max="" if n else 1 + i)
                 for i, (t, q, n) in enumerate(zip(seconds, qualities, n_invalid))]
        rows += found
        summary.append({**found[result], "iterations": "3"})
    write_csv(folder / "iterations.csv", COLUMNS, rows)
    write_csv(folder / "summary.csv", SUMMARY, summary)
    return read_results(folder)


class Histories(InFolder):
    def setUp(self):
        super().setUp()
        style.apply_style()
        self.addCleanup(style.pyplot.close, "all")

    def results(self, **methods):
        """Results of the one mesh `m`."""
        return write_history(self.folder / "r", {("m", name): values for name, values in methods.items()})

    def marks(self, axes, marker):
        """Positions of marks of a kind: a list of (x, y)."""
        return [tuple(line.get_xydata()[0]) for line in axes.get_lines()
                if line.get_marker() == marker and line.get_linestyle() == "None"]

    def legend(self, figure):
        return [text.get_text() for text in figure.legends[0].get_texts()]

    def test_the_record_of_the_result_is_ringed(self):
        results = self.results(getme=([0, 1, 2, 3], [.1, .2, .346, .3], [0] * 4, 2),
                               laplace=([0, 1, 2, 4], [.1, .2, .3, .4], [0] * 4, 3))
        figure = draw_history(results, ("q_min", "e_max"), "1")
        self.assertEqual(self.marks(figure.axes[0], "o"), [(2, .346), (4, .4)])
        self.assertEqual(self.marks(figure.axes[1], "o"), [(2, 3), (4, 4)])
        self.assertIn("Result", self.legend(figure))

    def test_a_result_that_is_not_recorded_has_no_ring(self):
        results = self.results(getme=([0, 1], [.1, .2], [0, 0], 1))
        results.summary.columns["q_min"][0] = "0.3"
        figure = draw_history(results, ("q_min",), "1")
        self.assertEqual(self.marks(figure.axes[0], "o"), [])
        self.assertNotIn("Result", self.legend(figure))

    def test_where_a_method_becomes_invalid_for_good_is_marked(self):
        results = self.results(laplace=([0, .01, .02, .03, .35], [.1, .2, .3, 0, 0], [0, 0, 0, 2, 1], 4),
                               getme=([0, .01, .02, .03], [.1, 0, .2, .3], [0, 1, 0, 0], 3))
        figure = draw_history(results, ("q_min", "e_max"), "1")
        for axes, y in zip(figure.axes, (.3, 3)):
            self.assertEqual(self.marks(axes, "x"), [(.02, y)])
            # The axis ends with the drawn data.
            self.assertAlmostEqual(axes.get_xlim()[1], 1.02 * .03)
        self.assertIn("Invalid from here", self.legend(figure))
        self.assertIn("laplace", self.legend(figure))

    def test_invalid_meshes_in_between_are_crossed(self):
        results = self.results(laplace=([0, 1, 2, 4], [.1, 0, .3, .4], [0, 2, 0, 0], 3),
                               getme=([0, 1, 2, 3], [.1, .2, .3, .4], [0] * 4, 3))
        for log_y, y in ((False, .2), (True, (.1 * .3) ** .5)):
            figure = draw_history(results, ("q_min", "e_max"), "1", log_y=log_y)
            bridge, = [line for line in figure.axes[0].get_lines() if line.get_label() == "_gap"]
            np.testing.assert_allclose(bridge.get_xydata(), [(0, .1), (1, y), (2, .3)])
            self.assertEqual((bridge.get_marker(), list(bridge.get_markevery())), ("x", [1]))
            self.assertIn("Invalid meshes", self.legend(figure))

    def test_one_panel_has_no_letter_and_no_title(self):
        results = self.results(getme=([0, 1, 2], [.1, .2, .3], [0] * 3, 2))
        axes, = draw_history(results, ("h1_error",), "1", log_y=True).axes
        self.assertEqual((axes.get_title(), axes.get_ylabel()), ("", "$\\Vert u-u_h\\Vert_{H^1}$  ($d=1$, log)"))
        axes = draw_history(results, ("q_min", "e_max"), "1").axes
        self.assertEqual((axes[0].get_title(), axes[1].get_ylabel()), ("m", "(b)  thesis $e_{\\max}$  ($d=1$)"))

    def test_vertical_axes_fit_the_numbers(self):
        for qualities, low in (([.8, .85, .9], .75), ([.1, .2, .9], -.1)):
            with self.subTest(low=low):
                results = write_history(self.folder / str(low), {("m", "getme"): ([0, 1, 2], qualities, [0] * 3, 2)})
                axes, = draw_history(results, ("q_mean",), "1").axes
                bottom, top = axes.get_ylim()
                self.assertGreater(bottom, low)
                self.assertGreater((max(qualities) - min(qualities)) / (top - bottom), .75)

    def test_ranges_of_axes(self):
        results = self.results(getme=([0, 1, 2, 3], [.1, .2, .3, .4], [0] * 4, 3))
        axes, = draw_history(results, ("q_min",), "1", x_range=(None, 1.5), y_range=(0.05, None)).axes
        self.assertEqual((axes.get_xlim()[1], axes.get_ylim()[0]), (1.5, .05))
        self.assertLess(axes.get_ylim()[1], .25)  # as high as the numbers shown
        self.assertAlmostEqual(axes.get_xlim()[0], -.03)  # the margin of this range
        axes, = draw_history(results, ("q_min",), "1", log_x=True, x_range=(.5, 4)).axes
        self.assertEqual((axes.get_xlim(), axes.get_xlabel()), ((.5, 4), "Smoothing time (s), log"))

    def test_a_method_that_is_invalid_throughout_is_called_so(self):
        never = ([0, 1, 2], [.1, 0, 0], [0, 3, 3], 2)
        valid = ([0, 1, 2], [.1, .2, .3], [0, 0, 0], 2)
        results = write_history(self.folder / "r", {
            ("one", "laplace"): never, ("one", "own"): never, ("one", "getme"): valid,
            ("two", "laplace"): never, ("two", "own"): valid, ("two", "getme"): valid})
        figure = draw_history(results, ("q_min",), "1")
        legend = self.legend(figure)
        self.assertIn("laplace (invalid)", legend)
        self.assertTrue({"own", "getme"} <= set(legend))
        self.assertEqual([axes.get_title() for axes in figure.axes], ["one\ninvalid: own", "two"])

    def test_what_starts_at_zero_has_a_point_at_the_left_edge_of_logarithmic_time(self):
        results = self.results(getme=([0, .1, 10], [.1, .2, .3], [0] * 3, 2),
                               own=([.01, .1, 10], [.1, .2, .3], [0] * 3, 2))
        figure = draw_history(results, ("q_min",), "1", True)
        axes, = figure.axes
        lines = {line.get_label(): line for line in axes.get_lines()}
        x = lines["getme"].get_xdata()
        self.assertTrue(axes.get_xlim()[0] < x[0] < .01)
        np.testing.assert_array_equal(x[1:], [.1, 10])
        np.testing.assert_array_equal(lines["own"].get_xdata(), [.01, .1, 10])
        left = axes.transAxes.inverted().transform(axes.transData.transform((x[0], .1)))[0]
        self.assertLess(left, 0.05)
        self.assertEqual(axes.get_xlabel(), "Smoothing time (s), log; 0 at the left edge")

    def test_labels_of_a_column_stay_off_the_panels_before_it(self):
        results = write_history(self.folder / "r", {
            (mesh, "getme"): ([0, 1, 2], values, [0] * 3, 2)
            for mesh, values in (("one", [.1, .2, .3]), ("two", [12345.25, .00012, .5]))})
        for log_y in (False, True):
            figure = draw_history(results, ("q_min", "e_max"), "1", log_y=log_y)
            renderer = figure.canvas.get_renderer()
            axes = np.array(figure.axes).reshape(2, 2)
            for row in axes:
                left = row[0].get_window_extent(renderer).x1
                self.assertGreater(row[1].yaxis.get_tightbbox(renderer).x0, left)
                self.assertGreater(row[0].yaxis.get_tightbbox(renderer).x0, 0)

    def test_words_stay_off_steep_lines(self):
        results = self.results(slow=([0, 99], [.1, .2], [0, 0], 1), fast=([0, 1], [.1, .9], [0, 0], 1))
        figure = draw_history(results, ("q_min",), "1")
        words, = figure.axes[0].texts
        self.assertEqual(words.get_text().replace("\n", " "), "slow ends after 99 s; its result: 0.2")

    def test_other_columns(self):
        results = self.results(getme=([0, 1, 2], [.1, .2, .3], [0] * 3, 2))
        figure = draw_history(results, ("e_max",), "1", x="q_min", log_y=True)
        axes, = figure.axes
        np.testing.assert_array_equal(axes.get_lines()[0].get_xydata(), [(.1, 1), (.2, 2), (.3, 3)])
        self.assertEqual((axes.get_xscale(), axes.get_yscale()), ("linear", "log"))
        self.assertEqual(axes.get_xlabel(), r"$q_{\min}$")

    def test_numbers_of_cells_are_known_of_invalid_meshes(self):
        results = self.results(laplace=([0, 1, 2], [.1, 0, 0], [0, 3, 2], 2))
        line = panel_lines(results, "n_invalid", "m", "1")["laplace"]
        np.testing.assert_array_equal(line.y, [0, 3, 2])
        self.assertEqual(line.invalid_after, 0)


class Ranges(InFolder):
    def panel(self, *ends):
        return {str(i): Line(np.array([0, end]), np.array([.1, .2]), np.array([True, True]))
                for i, end in enumerate(ends)}

    def test_a_dominant_method_ends_the_axis_early(self):
        self.assertEqual(dominant_method({"a": 1.0, "b": 30.0}), ("b", 5.0))
        for ends in ((1.0, 10.0), (1.0,), (0.0, 10.0)):
            self.assertEqual(dominant_method(dict(zip("ab", ends))), ("", np.inf))
        self.assertEqual(range_of([self.panel(1.0, 30.0)], False).high, 5.0)

    def test_other_columns_than_time_are_shown_as_a_whole(self):
        for column, low in (("iteration", -0.6), ("cg_iterations", -0.6)):
            extent = range_of([self.panel(1.0, 30.0)], False, column)
            self.assertAlmostEqual(extent.low, low)
            self.assertAlmostEqual(extent.high, 30.6)
        self.assertEqual(extent.dominant, "")

    def test_all_rows_have_the_range_of_all(self):
        for panels in itertools.permutations([self.panel(1.0), self.panel(3.0)]):
            self.assertAlmostEqual(range_of(panels, False).high, 3.06)

    def test_without_any_number(self):
        nothing = {"a": Line(np.array([np.nan]), np.array([np.nan]), np.array([False]))}
        for logarithmic in (False, True):
            extent = range_of([nothing], logarithmic)
            self.assertLess(extent.low, extent.high)
