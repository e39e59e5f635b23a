# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures of a tiny study: that they are made, what they show, and that they are reproducible."""

import contextlib
import csv
import io
from unittest import mock

import numpy as np

from plots.__main__ import main
from plots.figures import style
from plots.figures.diagrams import styles_in_order
from plots.figures.history import annotate_free_area, draw_history
from plots.figures.history_study import plan_histories
from plots.figures.norms import plan_norms
from plots.report.looks import SYMBOLS, looks_of
from plots.results import method_styles
from plots.results.smoothing import read_results
from plots.tests.synthetic_results import change_provenance, without_finite_elements, write_csv, write_results
from plots.tests.test_read_results import InFolder

LEAST_DISTANCE = 15  # in CIELAB; 2 is just noticeable
# Linear RGB as seen with normal sight, without red cones, and without green cones: G. M. Machado et al., "A
# Physiologically-based Model for Simulation of Color Vision Deficiency" (2009).
VIEWS = (np.eye(3),
         np.array([[.152286, 1.052583, -.204868], [.114503, .786281, .099216], [-.003882, -.048116, 1.051998]]),
         np.array([[.367322, .860646, -.227968], [.280085, .672501, .047413], [-.011820, .042940, .968881]]))
XYZ = np.array([[.4124, .3576, .1805], [.2126, .7152, .0722], [.0193, .1192, .9505]])


def lab_colour(colour, view):
    """A colour in CIELAB as it is seen."""
    linear = np.array([((int(colour[i:i + 2], 16) / 255 + .055) / 1.055)**2.4 for i in (1, 3, 5)])
    x, y, z = np.cbrt(np.clip(view @ linear, 0, 1) @ XYZ.T / XYZ.sum(axis=1))
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


class Figures(InFolder):
    def run_main(self, *arguments):
        output, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
            self.assertEqual(main([str(argument) for argument in arguments]), 0, errors.getvalue())
        return output.getvalue(), errors.getvalue()

    def test_same_results_give_the_same_bytes(self):
        folder = write_results(self.folder / "r")
        contents = []
        for _ in range(2):
            self.run_main(folder, "--quiet")
            files = sorted([*folder.glob("figures/*"), *folder.glob("tables/*")])
            contents.append({path.name: path.read_bytes() for path in files})
        self.assertEqual(contents[0], contents[1])
        names = {"figure_6_2_model", "figure_6_3_meshes", "figure_6_3_meshes_full",
                 "figure_6_4_history", "figure_6_4_history_log_time", "figure_history_d1", "figure_history_d2",
                 "figure_histograms", "figure_histograms_log",
                 "figure_history_norms_d1", "figure_history_norms_d2"}
        self.assertEqual({path.name for path in folder.glob("figures/*")},
                         {name + suffix for name in names for suffix in (".pdf", ".png")})

    def test_three_errors_of_one_solution_stand_side_by_side(self):
        folder = write_results(self.folder / "r")
        self.assertEqual(plan_norms(read_results(folder)), [])  # no best approximation was recorded
        with open(folder / "summary.csv", newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        write_csv(folder / "summary.csv", [*rows[0], "h1_best"],
                  [{**row, "e_h1": 4.0, "h1_error": 2.0, "h1_best": 1.0 + (row["method"] == "initial")} for row in rows])
        plan, = plan_norms(read_results(folder))
        figure = plan.draw()
        self.assertEqual([ax.get_title() for ax in figure.axes], ["Triangular mesh, $d$ = 1", "Triangular mesh, $d$ = 2"])
        of_thesis, true, best = (line.get_xdata().tolist() for line in figure.axes[0].lines)
        self.assertEqual((of_thesis, true, best), ([4.0] * 3, [2.0] * 3, [2.0, 1.0, 1.0]))
        self.run_main(folder, "--quiet", "--only", "table_6_3_errors")
        text = (folder / "tables" / "table_6_3_errors.md").read_text()
        self.assertIn("least H1", text)

    def test_other_study_several_meshes_one_mesh_file_missing(self):
        folder = write_results(self.folder / "r", "slab", ("a", "b", "c"), ("own", "other", "laplace"))
        (folder / "meshes" / "b_own.vtu").unlink()
        with mock.patch("plots.figures.style.DPI", 40):
            output, errors = self.run_main(folder, "--format", "png", "--verbose")
        self.assertIn("b_own.vtu", errors)
        self.assertIn("figures/model.png", output)
        self.assertTrue((folder / "figures" / "history_log_time.png").exists())

    def test_no_figures_and_no_meshes(self):
        folder = write_results(self.folder / "r")
        self.run_main(folder, "--no-figures")
        self.assertFalse((folder / "figures").exists())
        for path in (folder / "meshes").iterdir():
            path.unlink()
        with mock.patch("plots.figures.style.DPI", 40):
            self.run_main(folder, "--format", "png")
        self.assertTrue((folder / "figures" / "figure_6_4_history.png").exists())
        self.assertFalse((folder / "figures" / "figure_6_2_model.png").exists())

    def test_gaps_where_the_mesh_is_invalid(self):
        results = read_results(write_results(self.folder / "r"))
        style.apply_style()
        figure = draw_history(results, ("q_min", "e_max"), "1")
        for axes in figure.axes:
            lines = {line.get_label(): line for line in axes.get_lines()}
            np.testing.assert_array_equal(np.isnan(lines["weighted-laplace"].get_ydata()),
                                          [False, True, False, False])
            self.assertFalse(np.isnan(lines["getme"].get_ydata()).any())
        style.pyplot.close(figure)

    def test_words_stay_off_the_lines(self):
        for height, expected in ((0.1, 0.9), (0.95, 0.1)):
            figure, axes = style.pyplot.subplots()
            axes.plot([0, 1], [height, height])
            axes.set(xlim=(0, 1), ylim=(0, 1))
            annotate_free_area(axes, ["words"])
            self.assertAlmostEqual(axes.texts[0].get_position()[1], expected)
            style.pyplot.close(figure)

    def test_warpage_that_spans_magnitudes_has_a_logarithmic_axis(self):
        results = read_results(write_results(self.folder / "r"))
        numbers = results.iterations.columns["w_mean"]
        style.apply_style()
        for factor, scale in ((0.9, "linear"), (0.1, "log")):
            numbers[:] = [str(0.5 * factor ** (i % 4)) for i in range(len(numbers))]
            figure = draw_history(results, ("q_mean", "w_mean"), "1")
            self.assertEqual([axes.get_yscale() for axes in figure.axes], ["linear", scale])
            style.pyplot.close(figure)

    def test_figures_of_many_meshes(self):
        folder = without_finite_elements(
            write_results(self.folder / "r", "slab", ("a", "a-distorted", "b", "b-distorted")))
        with mock.patch("plots.figures.style.DPI", 40):  # what they look like is not looked at here
            self.run_main(folder, "--quiet", "--format", "png")
        names = {path.stem for path in folder.glob("figures/*.png")}
        self.assertLessEqual({"history_a", "history_b_log_time", "histograms_a", "histograms_b_log",
                              "histogram_differences", "meshes", "meshes_full"}, names)

    def test_true_errors_first_and_norms_of_the_thesis_for_its_own_study(self):
        def columns_of(results):
            return {figure.name: [axes.get_ylabel() for axes in figure.draw().axes[::2]] for figure in plan_histories(results)}
        style.apply_style()
        self.addCleanup(style.pyplot.close, "all")
        folder = write_results(self.folder / "r", meshes=("tri", "quad"))
        in_thesis = columns_of(read_results(folder))
        self.assertEqual([label.split("(")[1] for label in in_thesis["figure_6_4_history"]],
                         ["a)  $q_{\\min}$", "b)  $q_{\\mathrm{mean}}$", "c)  thesis $e_{\\max}$  ", "d)  thesis $e_{\\mathrm{mean}}$  "])
        self.assertIn("(c)  $\\Vert u-u_h\\Vert_{H^1}$  ($d=2$)", in_thesis["figure_history_d2"])
        change_provenance(folder, built_in=False)
        own = columns_of(read_results(folder))
        self.assertEqual(set(own), {"history", "history_log_time", "history_d2"})
        self.assertNotIn("thesis", str(own))

    def test_no_two_methods_look_alike(self):
        known = list(method_styles.KNOWN_METHODS)
        colours = {look.colour for look in method_styles.KNOWN_METHODS.values()}
        self.assertFalse(colours & set(method_styles.OWN_COLOURS))
        for n_methods in range(1, 21):
            for n_known in range(min(n_methods, len(known)) + 1):
                methods = known[len(known) - n_known:] + [f"own-{i}" for i in range(n_methods - n_known)]
                styles = method_styles.method_styles(methods + [methods[0] + method_styles.PARALLEL_SUFFIX])
                looks = {(look.colour, look.marker, look.hollow) for look in styles.values()}
                self.assertEqual(len(looks), len(styles), methods)
                for name in methods[n_known:]:
                    self.assertNotIn(styles[name].colour, colours)
        self.assertLessEqual({look.marker for look in styles.values()}, set(SYMBOLS))

    def test_the_colour_blind_can_tell_own_colours_apart(self):
        others = [look.colour for look in method_styles.KNOWN_METHODS.values()]
        for number, colour in enumerate(method_styles.OWN_COLOURS):
            for other in (*others, *method_styles.OWN_COLOURS[:number]):
                for view in VIEWS:
                    distance = np.linalg.norm(lab_colour(colour, view) - lab_colour(other, view))
                    self.assertGreater(distance, LEAST_DISTANCE, (colour, other))

    def test_a_method_looks_the_same_whatever_is_chosen(self):
        results = read_results(write_results(self.folder / "r", methods=("getme", "angle", "spring", "laplace")))
        whole = styles_in_order(results)
        self.assertNotEqual(whole["angle"].colour, whole["spring"].colour)
        for methods in (["spring"], ["spring", "getme"], ["angle"]):
            some = styles_in_order(results.restricted(methods))
            self.assertEqual({name: whole[name] for name in some}, some)
        looks = looks_of(results.study_methods)
        self.assertEqual(looks["spring"]["colour"], whole["spring"].colour)
        self.assertEqual(looks["getme"], {"colour": "#D55E00", "symbol": "circle", "dash": "solid"})
        # A method that is added at the end changes no other.
        self.assertEqual(method_styles.method_styles((*results.methods, "more"))["spring"], whole["spring"])

    def test_markers_and_dashes_tell_methods_apart(self):
        methods = (*method_styles.KNOWN_METHODS, "mine", "yours", "another")
        styles = method_styles.method_styles(methods)
        for attribute in ("colour", "marker", "dashes"):
            known = [getattr(styles[name], attribute) for name in method_styles.KNOWN_METHODS]
            self.assertEqual(len(set(known)), len(known), attribute)
        self.assertEqual(len({(look.colour, look.marker) for look in styles.values()}), len(styles))
        parallel = method_styles.method_styles((*methods, "getme-parallel"))
        self.assertEqual({name: parallel[name] for name in styles}, styles)
        self.assertEqual(parallel["getme-parallel"].colour, styles["getme"].colour)
        self.assertNotEqual(parallel["getme-parallel"].dashes, styles["getme"].dashes)
        self.assertTrue(parallel["getme-parallel"].hollow)
