# SPDX-License-Identifier: GPL-3.0-or-later
"""The search for parameters: ratios to the first method on half of the meshes, confirmed on the other."""

import csv
import json
import math

from plots.claims.reasons import reference
from plots.results.data_folder import thesis_folder
from plots.results.smoothing import read_results
from plots.tests.synthetic_results import COLUMNS, write_csv, write_results
from plots.tests.test_read_results import InFolder
from plots.tuning import RULES, candidates, geometric_mean, halves, main, report, winner

AT_END, AT_EQUAL_TIME = RULES
METHODS = ("usual", "better", "slow", "invalid", "flat")
MESHES = ("a", "b", "c", "d")


class Tuning(InFolder):
    def setUp(self):
        super().setUp()
        write_results(self.folder / "t", meshes=MESHES, methods=METHODS)
        with open(self.folder / "t" / "summary.csv", newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        for row in rows:
            method = row["method"]
            error = {"usual": 1.0, "better": 0.5 if row["mesh"] in "ac" else 0.9}.get(method, 0.1)
            row.update(l2_error=error, h1_error=error, smoothing_seconds=5 if method == "slow" else 2,
                       n_invalid=1 if method == "invalid" and row["mesh"] == "a" else 0, q_mean=0.8,
                       q_star_min=0.1 if method == "flat" else 0.4)
        write_csv(self.folder / "t" / "summary.csv", list(rows[0]), rows)
        self.write_records(rows)
        self.results = read_results(self.folder / "t")

    def write_records(self, ends):
        """Each method starts at an error of 3; the slow one has 0.4 after 1 s."""
        rows = []
        for end in ends:
            if end["method"] == "initial":
                continue
            records = {0: 3.0, **({1: 0.4} if end["method"] == "slow" else {}), end["smoothing_seconds"]: end["l2_error"]}
            rows += [{**end, "iteration": number, "smoothing_seconds": seconds, "l2_error": error, "h1_error": error}
                     for number, (seconds, error) in enumerate(records.items())]
        write_csv(self.folder / "t" / "iterations.csv", COLUMNS, rows)

    def test_meshes_take_turns(self):
        self.assertEqual(halves(MESHES), (("a", "c"), ("b", "d")))

    def test_ratios_are_to_the_first_method(self):
        usual, better, slow, *_ = candidates(self.results, ("a", "b"), AT_END)
        self.assertEqual(usual.error, 1)
        self.assertAlmostEqual(better.error, math.sqrt(0.5 * 0.9))
        self.assertAlmostEqual(slow.ratios["smoothing_seconds"], 2.5)

    def test_who_may_win(self):
        found = candidates(self.results, ("a", "c"), AT_END)
        self.assertEqual([c.method for c in found if c.is_allowed], ["usual", "better"])
        self.assertEqual(winner(found).method, "better")

    def test_at_equal_time_numbers_are_those_between_two_records(self):
        # The first method ends after 2 s, with an error of 1; the slow one is on the way from 0.4 at 1 s to 0.1 at 5 s.
        usual, _, slow, *_ = candidates(self.results, ("a", "c"), AT_EQUAL_TIME)
        self.assertEqual(usual.error, 1)
        self.assertAlmostEqual(slow.error, 0.4 - 0.3 / 4)
        self.assertAlmostEqual(slow.ratios["smoothing_seconds"], 2.5)
        self.assertTrue(slow.is_allowed)

    def test_geometric_mean(self):
        self.assertAlmostEqual(geometric_mean([1, 4]), 2)
        self.assertEqual(geometric_mean([0, 4]), 0)
        self.assertTrue(math.isnan(geometric_mean([math.nan, 4])))

    def test_the_tuned_preset_is_the_winner_at_equal_time(self):
        presets = thesis_folder().parent / "presets"
        own, base = (json.loads((presets / name).read_text(encoding="utf-8"))
                     for name in ("tuned.json", "thesis-6.3.json"))
        self.assertEqual(own["extends"], "thesis-6.3")
        for name in ("planar", "volume"):
            results = read_results(reference() / "tuning" / name)
            best = winner(candidates(results, halves(results.meshes)[0], AT_EQUAL_TIME)).method
            taken, = (method["parameters"] for method in results.provenance["methods"] if method["name"] == best)
            preset = {**base[name]["simultaneous"], **own.get(name, {}).get("simultaneous", {})}
            for parameter, (value, *_) in preset.items():
                used = taken[f"simultaneous.{parameter}"]
                self.assertEqual(used if isinstance(value, str) else float(used), value, f"{name}: {parameter}")

    def test_findings_are_those_of_the_results(self):
        for name in ("planar", "volume"):
            folder = reference() / "tuning" / name
            self.assertEqual((folder / "findings.md").read_text(encoding="utf-8"), report(read_results(folder)))

    def test_who_wins_against_none(self):
        rows = [row for row in self.results.summary.records() if row["method"] != "better"]
        write_csv(self.folder / "t" / "summary.csv", list(rows[0]), rows)
        text = report(read_results(self.folder / "t"))
        self.assertIn("At the end: **usual**, none of the others that may win has lower errors.", text)

    def test_report(self):
        text = report(self.results)
        self.assertIn("At the end: **better**, errors 0.500 times as large, and 0.900 times on the other half: confirmed.",
                      text)
        self.assertIn("At equal time: **slow**, ", text)
        self.assertEqual(text.count("(may not win)"), 3 + 2)
        self.assertEqual(main([str(self.folder / "t")]), 0)
        self.assertEqual(main([]), 2)
        self.assertEqual(main([str(self.folder / "nowhere")]), 2)
