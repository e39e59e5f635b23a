# SPDX-License-Identifier: GPL-3.0-or-later
"""The overview of claims that is made from the reference results."""

import json
import re
import tempfile
import unittest
from pathlib import Path

from plots.claims.agreement import paired, same, within
from plots.claims.check import FAILS, HOLDS, read_claims
from plots.claims.overview import Study, again_cell, most_covered, overview, studies
from plots.claims.reasons import reference
from plots.results.data_folder import thesis_folder


class Overview(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made, cls.studies = overview(reference()), studies(reference())

    def test_every_claim_has_a_row_with_its_verdict(self):
        claims = json.loads((thesis_folder() / "claims.json").read_text(encoding="utf-8"))
        outcomes = [outcome for study in self.studies for outcome in study.outcomes]
        self.assertEqual(sorted(o.claim["id"] for o in outcomes), sorted(c["id"] for c in claims))
        for outcome in outcomes:
            row, = [line for line in self.made.splitlines() if line.startswith(f"| {outcome.claim['id']} |")]
            verdict = {HOLDS: "holds", FAILS: "**does not hold**"}.get(outcome.verdict, "**cannot be checked**")
            shown, seeds = re.fullmatch(r".* \| ([^|(]*?)( \(holds for \d+ of \d+ seeds\))? \|", row).groups()
            self.assertEqual(shown, verdict, row)
            self.assertEqual(seeds is not None, bool(outcome.seeds), row)

    def test_totals(self):
        first = [o for study in self.studies for o in study.outcomes if "revises" not in o.claim]
        n = {verdict: sum(o.verdict == verdict for o in first) for verdict in (HOLDS, FAILS)}
        self.assertTrue(self.made.startswith(
            f"Of {len(first)} claims {n[HOLDS]} hold, {n[FAILS]} do not hold, "
            f"{len(first) - n[HOLDS] - n[FAILS]} cannot be checked; of "), self.made[:200])

    def test_every_run_has_its_commit(self):
        paths = list(reference().rglob("provenance.json"))
        self.assertGreater(len(paths), len(self.studies))
        for path in paths:
            name = path.parent.relative_to(reference()).as_posix()
            row, = [line for line in self.made.splitlines() if line.startswith(f"| `{name}` |")]
            run = json.loads(path.read_text(encoding="utf-8"))
            self.assertIn(run["program"]["commit"][:7], row)
            self.assertIn(run["machine"]["system"], row)

    def test_a_study_that_was_run_again_says_whether_its_numbers_were_the_same(self):
        run = {"program": {"commit": "a" * 40}, "sessions": [{"commit": "a" * 40, "uncommitted_changes": False}]}
        row = {"study": "ring", "commit": "a" * 40, "again": "b" * 40, "rows": "9", "different": "0"}
        self.assertEqual(again_cell(row, run), "bbbbbbb: same")
        self.assertEqual(again_cell({**row, "different": "2"}, run), "bbbbbbb: **2 of 9 rows differ**")
        self.assertEqual(again_cell({**row, "commit": "c" * 40}, run), "–")
        self.assertEqual(again_cell({**row, "rows": ""}, run), "bbbbbbb: same program")
        self.assertEqual(again_cell({}, run), "–")
        found = [Study("ring", "Ring", [], run), Study("gear", "Gear", [], run)]
        self.assertEqual(most_covered(found, {}), ("aaaaaaa", ["ring", "gear"]))
        self.assertEqual(most_covered(found[:1], {"ring": row})[1], ["ring"])
        other = {"program": {"commit": "b" * 40}, "sessions": [{"commit": "b" * 40, "uncommitted_changes": False}]}
        self.assertEqual(most_covered([*found, Study("sphere", "Sphere", [], other)], {
            "ring": row, "gear": {**row, "study": "gear"}}), ("bbbbbbb", ["ring", "gear", "sphere"]))
        self.assertEqual(most_covered(found, {"ring": {**row, "different": "1"}}), ("aaaaaaa", ["ring", "gear"]))

    def test_a_study_that_was_never_run_is_there(self):
        with tempfile.TemporaryDirectory() as folder:
            found = overview(Path(folder))
        n = len([claim for claim in read_claims("ring") if "revises" not in claim])
        section = found.partition("## Embedded ring\n")[2].partition("##")[0]
        self.assertIn(f"Of {n} claims 0 hold, 0 do not hold, {n} cannot be checked", section)
        self.assertIn("there are no results", section)
        self.assertRegex(found, r"\| `ring` \| – \| – \| no results \| – \| – \|")
        self.assertNotIn("| holds |", found)


class Agreement(unittest.TestCase):
    def test_equal_digits(self):
        pairs = [({}, "0.20449", "0.2045"), ({}, "24", "24"), ({}, "40/2800", "40/2800"), ({}, "0.2044", "0.2045")]
        self.assertEqual(same(pairs), "3 of 4")

    def test_differences_beyond_the_printed_digits(self):
        near, far = ({"method": "near"}, "104", "1.0e+02"), ({"method": "far"}, "110", "100")
        self.assertEqual(within([near], lambda row: True), "within 0.0 %")
        self.assertEqual(within([near, far], lambda row: True), "within 9.5 %")
        self.assertEqual(within([near, far], lambda row: row["method"] == "near"), "within 0.0 %")

    def test_numbers_are_paired_by_their_keys(self):
        computed = [{"mesh": mesh, "degree": "1", "method": "getme", "q": q} for mesh, q in (("a", "1"), ("b", "2"))]
        row, empty = {"mesh": "b", "method": "getme", "q": "2.5"}, {"mesh": "a", "method": "getme", "q": ""}
        self.assertEqual(paired(computed, [empty, row], ["q"]), [(row, "2", "2.5")])


if __name__ == "__main__":
    unittest.main()
