# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of the solvers of a study that are not Poisson's, and which of their numbers are shown."""

import numpy as np

from plots.figures import style
from plots.figures.history_study import plan_histories, plan_requested_history
from plots.report.contents import contents
from plots.results.request import Request
from plots.results.rows import read_rows
from plots.results.smoothing import read_results
from plots.results.solvers import main_numbers
from plots.results.symbols import of_solver, short_column, symbol_of
from plots.tests.synthetic_results import change_provenance, without_finite_elements, write_csv, write_results
from plots.tests.test_read_results import InFolder

BYTES = {"column": "size.bytes", "unit": "B", "meaning": "Size of the file."}


class SolverFigures(InFolder):
    def setUp(self):
        super().setUp()
        style.apply_style()
        self.addCleanup(style.pyplot.close, "all")
        self.folder_of_results = write_results(self.folder / "r")

    def results(self, columns, solvers=()):
        """Results with these columns: name -> function of a row of iterations.csv, which summary.csv takes for its rows, too."""
        for name in ("iterations.csv", "summary.csv"):
            rows = read_rows(self.folder_of_results / name).records()
            for row in rows:
                row.update({column: value({"iteration": "3", **row}) for column, value in columns.items()})
            write_csv(self.folder_of_results / name, [*rows[0]], rows)
        if solvers:
            change_provenance(self.folder_of_results, solvers=solvers)
        return read_results(self.folder_of_results)

    def figures(self, results):
        """Name -> planned figure of those of solvers."""
        return {plan.name: plan for plan in plan_histories(results) if plan.name.startswith("solver_")}

    def test_each_degree_of_a_solver_has_a_figure(self):
        columns = {"beam.h1_error": lambda row: str(100.0 / 10**int(row["iteration"])), "beam.n_dofs": lambda row: "9",
                   "beam.cg_seconds": lambda row: row["iteration"]}
        planned = self.figures(self.results(columns, [{"label": "beam", "title": "Beam", "degrees": [1, 2], "numbers": []}]))
        self.assertEqual({name: plan.title for name, plan in planned.items()},
                         {"solver_beam": "Beam, d = 1", "solver_beam_d2": "Beam, d = 2"})
        axes, = planned["solver_beam_d2"].draw().axes  # neither the time nor what never changes
        self.assertEqual(axes.get_ylabel(), "beam: $\\Vert u-u_h\\Vert_{H^1}$  ($d=2$, log)")
        getme, = [line for line in axes.get_lines() if line.get_label() == "getme"]
        np.testing.assert_allclose(getme.get_xydata(), [(0, 100), (.01, 10), (.02, 1), (.03, .1)])

    def test_a_solver_without_degrees_has_one_figure_with_units(self):
        results = self.results({"size.bytes": lambda row: row["iteration"]}, [{"label": "size", "degrees": [], "numbers": [BYTES]}])
        planned = self.figures(results)
        self.assertEqual([*planned], ["solver_size"])
        self.assertEqual(planned["solver_size"].draw().axes[0].get_ylabel(), "size: bytes [B]")
        plan, = plan_requested_history(results, Request(y=("size: bytes",)))
        self.assertEqual(plan.name, "history_size_bytes")

    def test_failures_leave_gaps_and_a_solver_that_always_failed_has_no_figure(self):
        results = self.results({"flaky.n": lambda row: "" if row["iteration"] in "02" else row["iteration"],
                                "never.n": lambda row: ""})
        axes, = self.figures(results)["solver_flaky"].draw().axes
        getme, = [line for line in axes.get_lines() if line.get_label() == "getme"]
        np.testing.assert_array_equal(getme.get_ydata(), [np.nan, 1, np.nan, 3])
        self.assertEqual([solver.label for solver in results.solvers], ["flaky"])
        self.assertEqual(self.figures(read_results(write_results(self.folder / "old"))), {})

    def test_without_poisson_there_are_no_degrees(self):
        without_finite_elements(self.folder_of_results)
        results = self.results({"size.bytes": lambda row: row["iteration"]})
        self.assertEqual(results.degrees, ())
        axes, = self.figures(results)["solver_size"].draw().axes
        self.assertEqual(axes.get_ylabel(), "size: bytes")
        self.assertEqual(contents(results)["curves"]["columns"]["size.bytes"][-4:], [0.0, 1.0, 2.0, 3.0])

    def test_curves_of_the_report_say_what_they_show(self):
        results = self.results({"size.bytes": lambda row: row["iteration"]}, [{"label": "size", "degrees": [], "numbers": [BYTES]}])
        curves = contents(results)["curves"]
        self.assertEqual((curves["headings"]["size.bytes"], curves["meanings"]), ("size: bytes [B]", {"size.bytes": "Size of the file."}))


class Numbers(InFolder):
    def test_errors_iterations_and_the_condition_number_come_first(self):
        names = [f"s.{name}" for name in ("n", "u_max", "condition_number", "jacobi_condition_number", "cg_iterations", "e1_error",
                                          "e2_error", "e3_error", "e4_error", "e5_error")]
        self.assertEqual(main_numbers(names), ("s.e1_error", "s.e2_error", "s.e3_error", "s.e4_error", "s.cg_iterations",
                                               "s.condition_number"))
        self.assertEqual(main_numbers(names[:5]), ("s.cg_iterations", "s.condition_number", "s.n", "s.u_max", "s.jacobi_condition_number"))

    def test_columns_of_solvers_are_told_from_counts(self):
        self.assertEqual(of_solver("a.b.h1_error"), ("a.b", "h1_error"))
        self.assertEqual([of_solver(name)[0] for name in ("n_below_0.3", "n_star_below_0.3", "h1_error")], ["", "", ""])
        self.assertEqual((short_column("a.h1_error"), symbol_of("a.h1_error").text), ("a_h1", "a: H1 error"))
