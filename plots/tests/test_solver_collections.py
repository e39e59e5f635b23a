# SPDX-License-Identifier: GPL-3.0-or-later
"""Collections with other solvers than Poisson's, from invented results whose answers are known."""

import numpy as np

from plots.__main__ import main
from plots.collections.comparison import gains_by_number
from plots.collections.prediction import predictions
from plots.results.collection import read_collection_results
from plots.results.rows import read_rows
from plots.tests.synthetic_results import write_csv
from plots.tests.test_collection import write_collection
from plots.tests.test_read_results import InFolder


class SolversOfCollections(InFolder):
    def setUp(self):
        super().setUp()
        self.collection = write_collection(self.folder / "r")

    def results(self, **more):
        """Results with these columns of the solvers `beam` and `size`: name -> function of a row."""
        columns = {"beam.h1_error": lambda row: str(float(row["h1_error"])**2), "beam.cg_seconds": lambda row: "2",
                   "size.bytes": lambda row: str(100 - 10 * int(row["iteration"]) if row["method"] == "good" else 100), **more}
        path = self.collection / "iterations.csv"
        rows = [{**row, **{name: value(row) for name, value in columns.items()}} for row in read_rows(path).records()]
        write_csv(path, [*rows[0]], rows)
        return read_collection_results(self.collection)

    def test_methods_are_compared_by_the_numbers_of_a_solver(self):
        """`good` halves the H1 error of Poisson's equation, so it quarters its square. It takes 0.5 s, and one solution 2 s."""
        beam, _ = self.results().solvers
        good, idle = [gain for gain in gains_by_number(self.results(), beam)["beam.h1_error"] if gain.degree == "1"]
        self.assertAlmostEqual(good.ratio, 0.25)
        self.assertAlmostEqual(good.seconds, 0.25)
        self.assertAlmostEqual(idle.over_reference, 4.0)
        self.assertEqual((idle.p_value, good.n_problems), (2 / 2**8, 8))

    def test_a_solver_without_degrees_has_one_problem_a_member(self):
        results = self.results()
        beam, size = results.solvers
        self.assertEqual((beam.degrees, size.degrees), (("1", "2"), ()))
        good, idle = gains_by_number(results, size)["size.bytes"]
        self.assertEqual((good.degree, good.n_problems, idle.ratio), ("", 8, 1.0))
        self.assertAlmostEqual(good.ratio, 0.5)
        self.assertTrue(np.isnan(good.seconds))  # it records no times

    def test_failures_leave_the_initial_mesh_and_a_failed_initial_mesh_is_no_problem(self):
        def stress(row):
            failed = row["member"] == "m0" or row["member"] in ("m1", "m2") and row["iteration"] == "5"
            return "" if failed else "4" if row["iteration"] == "0" else "2"
        results = self.results(**{"beam.stress": stress})
        good, _ = [gain for gain in gains_by_number(results, results.solvers[0])["beam.stress"] if gain.degree == "2"]
        self.assertEqual(good.n_problems, 7)
        self.assertAlmostEqual(good.failed, 2 / 7)
        self.assertAlmostEqual(good.ratio, 0.5**(5 / 7))

    def test_numbers_without_ratios_are_left_out(self):
        results = self.results(**{"beam.signed": lambda row: str(int(row["iteration"]) - 2), "beam.n_dofs": lambda row: "9"})
        self.assertEqual([*gains_by_number(results, results.solvers[0])], ["beam.h1_error"])

    def test_tables_and_findings_without_poisson(self):
        self.results(h1_error=lambda row: "", l2_error=lambda row: "")
        self.assertEqual(main([str(self.collection), "--quiet", "--no-figures"]), 0)
        tables = self.collection / "tables"
        self.assertFalse((tables / "table_smoothing.md").exists())
        self.assertIn("| H1 error | triangles | 2 | 0.5 | Good | 0.250 | 0.250 to 0.250 | 1.000 |", (tables / "table_solver_beam.md").read_text())
        text = (tables / "findings.md").read_text()
        self.assertIn("- Triangles, degree 1, distorted to 0.5: Good leaves 0.250 (0.250 to 0.250) of the H1 error of beam, on 8 problems", text)
        self.assertIn("- Triangles, distorted to 0.5, bytes of size over that of Good: Idle 2.000 (2.000 to 2.000); different from Good", text)

    def test_errors_after_equal_times(self):
        """`good` has ended after 0.5 s, a quarter of one solution, with a quarter of beam's error."""
        self.results()
        self.assertEqual(main([str(self.collection), "--quiet", "--no-figures"]), 0)
        lines = (self.collection / "tables" / "table_budgets_beam.md").read_text().splitlines()
        line, = [line for line in lines if line.startswith("| H1 error | triangles | 1 | 0.5 | Good |")]
        self.assertIn("0.250", line.split("|")[8])
        self.assertFalse((self.collection / "tables" / "table_budgets_size.md").exists())  # no times

    def test_quality_predicts_their_errors(self):
        """The H1 error of beam falls as q_mean rises."""
        found = {(p.quality, p.outcome, p.degree): p.mean for p in predictions(self.results())}
        self.assertAlmostEqual(found["q_mean", "beam.h1_error", "1"], -1.0)
        self.assertNotIn(("q_mean", "size.bytes", "1"), found)

    def test_collections_without_other_solvers_have_none(self):
        self.assertEqual(read_collection_results(self.collection).solvers, ())
