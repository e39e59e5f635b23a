# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables and figures of a collection, from invented results whose answers are known."""

import contextlib
import csv
import io
import json
import lzma
from dataclasses import replace
from pathlib import Path

import numpy as np

from plots.__main__ import main
from plots.collections.comparison import AS_IS, NEXT_DEGREE, SPLIT, Payoff, at_budgets, error_in_time, gains, payoffs
from plots.collections.findings import verdict, what_got_worse, which_method
from plots.collections.prediction import RECORDS_OF_CURVE, differ, predictions, relative_to_least, some_of_each_curve
from plots.collections.problems import problems_of
from plots.results.collection import KEYS, MEMBER_COLUMNS, NUMBERS, RECORD, REFINED, STATISTICS, SUMMARY, read_collection_results
from plots.results.rows import SOLVING, ResultsError, Rows, solving_seconds
from plots.tables.gains import gains_table
from plots.tables.pairs import pairs_table
from plots.tests.synthetic_results import write_csv
from plots.tests.test_read_results import InFolder

N_RECORDS = 6


def write_collection(folder, n_members=8):
    """Members in as many families: `good` halves the H1 error with rising q_mean, `idle` changes nothing; degree 2 has
    a tenth of the error of degree 1."""
    folder.mkdir()
    rows, members = [], []
    for m in range(n_members):
        member = {"member": f"m{m}", "family": f"f{m}", "elements": "triangles", "distortion": "0.5",
                  "solution": "",
                  "status": "complete", "reason": ""}
        members.append(member)
        for degree in (1, 2):
            for method in ("idle", "good"):
                for i in range(N_RECORDS):
                    gain = i / (N_RECORDS - 1) if method == "good" else 0.0
                    error = (1.0 + m) * (1.0 - 0.5 * gain) / 10.0**(degree - 1)
                    rows.append({**member, "mesh": f"mesh{m}", "method": method, "stage": "s", "iteration": i,
                                 "degree": degree,
                                 "smoothing_seconds": 0.1 * i * (1 if method == "good" else 2),
                                 "preparation_seconds": 0, "assembly_seconds": 0.2, "cg_seconds": 9,
                                 "jacobi_cg_seconds": 0.3, "amg_setup_seconds": 0.2, "amg_cg_seconds": 0.2, "n_invalid": 0, "q_min": 0.3,
                                 "q_star_min": 0.2 + 0.001 * (7 * i % 5), "q_mean": 0.5 + 0.3 * gain,
                                 "l2_error": error**2, "h1_error": error, "condition_number": 100,
                                 "cg_iterations": 30})
    members.append({**member, "member": "broken", "status": "failed", "reason": "tangled"})
    write_csv(folder / "iterations.csv", tuple(dict.fromkeys((*KEYS, *RECORD, *NUMBERS))), rows)
    write_csv(folder / "members.csv", MEMBER_COLUMNS, members)
    (folder / "provenance.json").write_text(json.dumps(
        {"study": "many", "study_title": "Many", "parameters": {"kind": "collection"},
         "methods": [{"name": "good", "title": "Good"}, {"name": "idle", "title": "Idle"}]}))
    return folder


class Collection(InFolder):
    def setUp(self):
        super().setUp()
        self.results = read_collection_results(write_collection(self.folder / "r"))

    def test_what_predicts_the_error_is_found(self):
        found = {(p.quality, p.outcome, p.degree): p for p in predictions(self.results)}
        best, other = found["q_mean", "h1_error", "1"], found["q_star_min", "h1_error", "1"]
        self.assertAlmostEqual(best.mean, -1.0)
        self.assertEqual((len(best.by_family), best.n_records), (8, 8 * 10))  # the last mesh of idle is its first
        np.testing.assert_allclose(best.interval, (-1.0, -1.0))
        self.assertGreater(abs(best.mean), abs(other.mean))
        self.assertEqual(differ(best, other), 2 / 2**8)
        self.assertTrue(np.isnan(found["q_min", "h1_error", "2"].mean))  # always the same

    def test_curves_weigh_alike(self):
        chosen = some_of_each_curve(np.array(["m"] * 103), np.array(["long"] * 101 + ["short"] * 2))
        self.assertEqual(list(chosen), [0, 20, 40, 60, 80, 100, 101, 102])
        self.assertEqual(len(chosen), RECORDS_OF_CURVE + 2)

    def test_metrics_are_qualities_too(self):
        rows = [{"member": f"m{m}", "mesh": f"mesh{m}", "method": method, "stage": "s", "iteration": i, "metric": "max_angle",
                 "better": "smaller", "min": 1, "mean": 90 - i, "max": 120 - (i if method == "good" else 0)}
                for m in range(8) for method in ("idle", "good") for i in range(N_RECORDS)]
        write_csv(self.folder / "r" / "metrics.csv", (*RECORD, *STATISTICS), rows)
        results = read_collection_results(self.folder / "r")
        self.assertEqual(results.qualities, ("q_min", "q_star_min", "q_mean", "mean max angle", "worst max angle"))
        chosen = results.iterations.select(member="m3", method="good", degree="2")
        np.testing.assert_array_equal(chosen.number("worst max angle"), 120 - np.arange(N_RECORDS))
        np.testing.assert_array_equal(chosen.number("mean max angle"), 90 - np.arange(N_RECORDS))
        found = {(p.quality, p.outcome, p.degree): p.mean for p in predictions(results)}
        self.assertAlmostEqual(found["worst max angle", "h1_error", "1"], 1.0, places=2)

    def test_gains_are_means_over_families(self):
        good, idle = [gain for gain in gains(problems_of(self.results), self.results.methods) if gain.degree == "1"]
        self.assertEqual((good.method, good.level, good.n_problems, good.n_families), ("good", "0.5", 8, 8))
        self.assertAlmostEqual(good.ratio, 0.5)
        np.testing.assert_allclose(good.interval, (0.5, 0.5))
        self.assertAlmostEqual(good.seconds, 0.5 / 0.5)
        self.assertTrue(np.isnan(good.p_value))
        self.assertAlmostEqual(idle.over_reference, 2.0)
        self.assertEqual(idle.p_value, 2 / 2**8)

    def test_families_count_once_and_levels_stay_apart(self):
        """Family a: two problems that halve the error; b: one that keeps it; another level: one that quarters it."""
        first = problems_of(self.results)[0]

        def problem(family, level, ratio):
            return replace(first, family=family, level=level, results={"good": first.initial._replace(error=ratio * first.initial.error)})
        found = gains([problem("a", "0.6", 0.5), problem("a", "0.6", 0.5), problem("b", "0.6", 1.0), problem("a", "as generated", 0.25)],
                      ("good",))
        self.assertEqual([(gain.level, gain.n_families) for gain in found], [("as generated", 1), ("0.6", 2)])
        self.assertAlmostEqual(found[0].ratio, 0.25)
        self.assertAlmostEqual(found[1].ratio, 0.5**0.5)

    def test_budgets_are_multiples_of_one_solution(self):
        """One solution takes 0.5 s. After 0.125 s `good` has its second mesh, after 0.5 s its last."""
        found = {(entry.method, entry.budget): entry.ratio for entry in at_budgets(problems_of(self.results), self.results.methods)
                 if entry.degree == "2"}
        self.assertAlmostEqual(found["good", 0.25], 0.9)
        self.assertAlmostEqual(found["good", 1.0], 0.5)
        self.assertAlmostEqual(found["idle", 4.0], 1.0)

    def test_payoff_has_error_and_time_over_those_of_the_initial_mesh(self):
        found = {(p.degree, p.method, p.change): p for p in payoffs(problems_of(self.results), ["good"])}
        good, higher = found["1", "good", AS_IS], found["1", "initial", NEXT_DEGREE]
        self.assertAlmostEqual(good.error, 0.5)
        self.assertAlmostEqual(good.time, (0.5 + 0.5) / 0.5)
        self.assertAlmostEqual(higher.error, 0.1)
        self.assertAlmostEqual(higher.time, 1.0)
        self.assertNotIn(("2", "initial", NEXT_DEGREE), found)
        self.assertTrue(np.isnan(good.at_equal_time))
        self.assertEqual(main([str(self.folder / "r"), "--quiet", "--only", "table_payoff"]), 0)
        self.assertIn("`set refined degrees = 1`", (self.folder / "r" / "tables" / "table_payoff.md").read_text())

    def test_what_knowing_the_solution_gains(self):
        """`good` solves, and halves the errors on the meshes of `idle`, but on one, where it is 4 times as large."""
        folder = self.folder / "r"
        self.assertEqual(gains_table(self.results).keys, ())
        rows = list(csv.DictReader((folder / "iterations.csv").read_text().splitlines()))
        write_csv(folder / "iterations.csv", [*rows[0], "n_solves"],
                  [{**row, "n_solves": row["iteration"] if row["method"] == "good" else ""} for row in rows])
        summary = [{"member": f"m{m}", "elements": "triangles", "solution": "front", "method": method, "degree": 1,
                    "n_invalid": int(m == 5 and method == "good"), "q_min": 0.1 * (m + 1), "l2_error": error**2,
                    "h1_error": error}
                   for m in range(8) for method, error in (("good", 4.0 if m == 3 else 0.5), ("idle", 1.0))]
        write_csv(folder / "summary.csv", SUMMARY, summary)
        found = gains_table(read_collection_results(folder))
        self.assertEqual([cell.text for cell in found.keys[0]], ["front", "triangles", "1", "Good"])
        self.assertEqual([[cell.text for cell in group.cells[0]] for group in found.groups],
                         [["8"], ["0.25", "2.00", "2.00"], ["0.06", "4.00", "4.00"], ["0.100"], ["1"]])

    def test_published_pairs(self):
        """Model a has both meshes, b only one: of a, `good` reaches the error of the published result, `idle` fails."""
        folder = self.folder / "r"
        self.assertEqual(pairs_table(self.results).keys, ())
        numbers = {("a_in", "initial"): (0.1, 4.0), ("a_in", "good"): (0.4, 2.0), ("a_in", "idle"): (0.0, ""), ("a_out", "initial"): (0.5, 2.0),
                   ("b_in", "initial"): (0.3, 1.0)}
        write_csv(folder / "summary.csv", SUMMARY, [
            {**dict.fromkeys(SUMMARY, ""), "member": f"{mesh}.{solution}", "elements": "hexahedra", "solution": solution, "method": method,
             "degree": degree, "n_invalid": int(error == ""), "q_min": q_min, "q_mean": q_min + 0.25,
             "h1_error": error and error * factor / degree}
            for (mesh, method), (q_min, error) in numbers.items() for solution, factor in (("smooth", 1.0), ("layer", 10.0))
            for degree in (1, 2)])
        found = pairs_table(read_collection_results(folder))
        self.assertEqual([[cell.text for cell in key] for key in found.keys],
                         [["a", "before"], ["a", "before, Good"], ["a", "before, Idle"], ["a", "as published, after"]])
        columns = {(group.heading.text, sub): [cells[i].text for cells in group.cells]
                   for group in found.groups for i, sub in enumerate(group.subheadings)}
        self.assertEqual(columns["q_min", ""], ["0.100", "0.400", "0.000", "0.500"])
        self.assertEqual(columns["q_mean", ""], ["0.350", "0.650", "0.250", "0.750"])
        self.assertEqual(columns["Invalid cells", ""], ["0", "0", "1", "0"])
        self.assertEqual(columns["H1 error, smooth", "d = 1"][::3], ["4", "2"])
        self.assertEqual(columns["H1 error, layer", "d = 2"][:2], ["20", "10"])
        self.assertNotIn(columns["H1 error, layer", "d = 2"][2], ("0", "20"))

    def test_at_equal_time_smoothing_is_compared_with_split_cells(self):
        """Split cells halve the error in four times the time: order 1/2. The mesh of `good` has half the error after twice
        the time of one solution, when the unsmoothed mesh has 1 / sqrt(2) of it."""
        common = {"assembly_seconds": 0, "cg_seconds": 2, "jacobi_cg_seconds": "", "amg_setup_seconds": "", "amg_cg_seconds": ""}
        write_csv(self.folder / "r" / "refined.csv", REFINED, [
            {"member": f"m{m}", "method": method, "degree": 1, **common, "h1_error": error * (1 + m)}
            for m in range(8) for method, error in (("initial", 0.5), ("good", 0.25), ("idle", 0.5))])
        results = read_collection_results(self.folder / "r")
        found = {(p.degree, p.method, p.change): p for p in payoffs(problems_of(results), ["good"])}
        self.assertAlmostEqual(found["1", "initial", SPLIT].error, 0.5)
        self.assertAlmostEqual(found["1", "initial", SPLIT].time, 4.0)
        self.assertAlmostEqual(found["1", "good", AS_IS].at_equal_time, 0.5 * 2.0**0.5)
        self.assertAlmostEqual(found["1", "good", SPLIT].error, 0.25)
        self.assertAlmostEqual(found["1", "good", SPLIT].time, 5.0)
        self.assertNotIn(("2", "initial", SPLIT), found)
        self.assertEqual(main([str(self.folder / "r"), "--quiet", "--only", "findings"]), 0)
        text = (self.folder / "r" / "tables" / "findings.md").read_text()
        self.assertIn("splitting every cell of the unsmoothed mesh leaves 0.500 for 4 times: smoothing pays. After the same time in all "
                      "its error is 0.707 (0.707 to 0.707) of that of the unsmoothed mesh.", text)

    def test_a_failure_leaves_the_initial_mesh(self):
        """`good` ends with invalid cells after 0.5 s, but on one member."""
        rows = self.results.iterations
        rows.columns["n_invalid"][(rows.text("method") == "good") & (rows.number("smoothing_seconds") > 0.45)
                                  & (rows.text("member") != "m3")] = "2"
        rows.columns["h1_error"][rows.text("n_invalid") == "2"] = ""
        problems = problems_of(self.results)
        good = gains(problems, self.results.methods)[0]
        self.assertAlmostEqual(good.ratio, 0.5**(1 / 8))
        self.assertAlmostEqual(good.failed, 7 / 8)
        found = {(entry.method, entry.budget): entry.ratio for entry in at_budgets(problems, self.results.methods) if entry.degree == "1"}
        self.assertAlmostEqual(found["good", 0.25], 0.9)
        self.assertAlmostEqual(found["good", 4.0], 0.5**(1 / 8))
        self.assertAlmostEqual({p.change: p for p in payoffs(problems, ["good"])}[AS_IS].error, 0.5**(1 / 8))
        text = "\n".join(what_got_worse(self.results, gains(problems, self.results.methods)))
        self.assertIn("Good has no valid result on 88 % of the problems (triangles, degree 1, distorted to 0.5)", text)
        self.assertIn("Valid results on all problems: Idle.", text)

    def test_results_of_the_summary_count(self):
        """A method returns another mesh than its last one."""
        folder = self.folder / "r"
        write_csv(folder / "summary.csv", SUMMARY,
                  [{**dict.fromkeys(SUMMARY, ""), "member": f"m{m}", "elements": "triangles", "method": method, "degree": 1, "n_invalid": 0,
                    "smoothing_seconds": 0.3, "preparation_seconds": 0, "cg_seconds": 0.4, "h1_error": 0.75 * (1 + m), "l2_error": 1}
                   for m in range(8) for method in ("initial", "good")])
        good, idle = gains(problems_of(read_collection_results(folder)), self.results.methods)[:2]
        self.assertAlmostEqual(good.ratio, 0.75)
        self.assertEqual((good.failed, idle.failed), (0.0, 1.0))

    def test_few_families_and_interpreted_methods_are_said(self):
        results = read_collection_results(write_collection(self.folder / "few", n_members=4))
        which = which_method(results, gains(problems_of(results), results.methods))
        self.assertEqual(which[0], "Triangles, degree 1, distorted to 0.5, errors over those of Good: Idle 2.000 (2.000 to 2.000); 4 families "
                                   "are too few for any test to separate methods.")
        results = replace(results, interpreted=frozenset({"idle"}))
        self.assertIn("Times of Idle include the Python interpreter", which_method(results, gains(problems_of(results), results.methods))[-1])

    def test_the_power_law_needs_two_points(self):
        self.assertAlmostEqual(error_in_time(1.0, 1.0, 0.5, 4.0)(16.0), 0.25)
        self.assertTrue(np.isnan(error_in_time(1.0, 1.0, np.nan, np.nan)(2.0)))
        self.assertTrue(np.isnan(error_in_time(1.0, 1.0, 0.5, 0.5)(2.0)))

    def test_solving_is_assembly_and_the_fastest_solver_there_is(self):
        def seconds(*fields):
            return solving_seconds(Rows(Path("x"), {name: np.array([field], dtype=object)
                                                    for name, field in zip(SOLVING, fields)}))[0]
        self.assertEqual(seconds("1", "8", "4", "2", "1"), 4.0)
        self.assertEqual(seconds("1", "8", "4", "2", "3"), 5.0)
        self.assertEqual(seconds("1", "8", "", "", ""), 9.0)
        self.assertEqual(seconds("", "2", "4", "", ""), 2.0)
        self.assertTrue(np.isnan(seconds("", "", "", "", "")))

    def test_relative_to_the_least_of_the_same_member(self):
        np.testing.assert_allclose(relative_to_least(np.array([2.0, 4.0, 3.0, 0.0]), np.array(["a", "a", "b", "b"])),
                                   [1.0, 2.0, 1.0, np.nan])

    def test_files(self):
        self.assertEqual(main([str(self.folder / "r"), "--quiet"]), 0)
        for name in ("prediction", "prediction_extremes", "profile", "runtime", "anytime"):
            for suffix in ("pdf", "png"):
                self.assertGreater((self.folder / "r" / "figures" / f"{name}.{suffix}").stat().st_size, 1000)
        for name in ("members", "smoothing", "budgets", "payoff", "prediction"):
            for suffix in ("csv", "md", "tex"):
                self.assertTrue((self.folder / "r" / "tables" / f"table_{name}.{suffix}").exists())
        text = (self.folder / "r" / "tables" / "table_members.md").read_text()
        self.assertIn("| f7 | 2 | 1 | 1 |", text)

    def test_findings_have_a_number_and_an_interval_each(self):
        self.assertEqual(main([str(self.folder / "r"), "--quiet", "--only", "findings"]), 0)
        text = (self.folder / "r" / "tables" / "findings.md").read_text()
        for sentence in (
                "- 8 of 9 members are complete: 16 problems, a member at a degree each, and 2 methods.",
                "- Not run, f7, 1 member: tangled.",
                "- Triangles, degree 1, distorted to 0.5: Good leaves 0.500 (0.500 to 0.500) of the error, on 8 problems of 8 families. It "
                "raises it by more than 1 % on 0 % of them.",
                "errors over those of Good: Idle 2.000 (2.000 to 2.000); different from Good, by an adjusted test: Idle (p = 0.0078).",
                "as unit, lowest ratio after 0.25 of its time: Good 0.900 (0.900 to 0.900); 1 of its time: Good 0.500",
                "leaves 0.500 (0.500 to 0.500) of the error, for 2 (2 to 2) times the time of one solution; degree 2 on the unsmoothed mesh "
                "leaves 0.100 for 1 times: the next degree is better and cheaper.",
                "- Triangles, degree 1: rank correlation with the error -1.00 (-1.00 to -1.00) for q_mean, the strongest of 2."):
            self.assertIn(sentence, text)

    def test_verdicts_say_who_is_better_and_who_is_dearer(self):
        def payoff(error, time):
            return Payoff("f", "1", "x", "m", AS_IS, error, (error, error), time, (time, time), np.nan, (np.nan, np.nan), 3)
        for smoothed, higher, said in (((.1, 1), (.2, 2), "smoothing pays"), ((.2, 2), (.1, 1), "better and cheaper"),
                                       ((.2, 1), (.1, 2), "the next degree is better, and dearer"),
                                       ((.1, 2), (.2, 1), "smoothing is better, and dearer")):
            self.assertIn(said, verdict(payoff(*smoothed), payoff(*higher), "the next degree"))

    def test_a_part_without_complete_members_has_its_table_of_members(self):
        folder = self.folder / "r"
        (folder / "iterations.csv").unlink()
        write_csv(folder / "members.csv", MEMBER_COLUMNS,
                  [{**dict.fromkeys(MEMBER_COLUMNS, ""), "member": "broken", "status": "failed"}])
        self.assertEqual(main([str(folder), "--quiet"]), 0)
        self.assertEqual({path.name for path in (folder / "tables").glob("*.md")}, {"table_members.md", "findings.md"})

    def test_records_may_be_packed(self):
        file = self.folder / "r" / "iterations.csv"
        packed = lzma.compress(file.read_bytes())
        file.unlink()
        file.with_name("iterations.csv.xz").write_bytes(packed)
        iterations = read_collection_results(self.folder / "r").iterations
        for name in (*KEYS, *NUMBERS):
            self.assertEqual(list(iterations.text(name)), list(self.results.iterations.text(name)))
        file.with_name("iterations.csv.xz").write_bytes(packed[:len(packed) // 2])
        with self.assertRaisesRegex(ResultsError, "looks truncated"):
            read_collection_results(self.folder / "r")

    def test_what_is_missing_is_said(self):
        (self.folder / "r" / "iterations.csv").unlink()
        errors = io.StringIO()
        with contextlib.redirect_stderr(errors):
            self.assertEqual(main([str(self.folder / "r"), "--quiet"]), 2)
        self.assertIn("iterations.csv: the file is missing", errors.getvalue())
