# SPDX-License-Identifier: GPL-3.0-or-later
"""The overview of what holds of the thesis, in results/README.md."""

import unittest

from plots.claims.check import FAILS, HOLDS
from plots.claims.overview import (BEGIN, END, outcomes_of, overview, readme, reference,
                                   results_folders, with_overview)
from plots.results.rows import ResultsError


class Overview(unittest.TestCase):
    def test_it_is_made_from_the_results_there_are(self):
        text = readme().read_text(encoding="utf-8")
        self.assertEqual(text, with_overview(text, overview(reference())),
                         "run python3 -m plots.claims.overview")

    def test_every_claim_has_a_row_with_its_verdict(self):
        made = overview(reference())
        for folder in results_folders(reference()):
            _, outcomes = outcomes_of(folder)
            self.assertTrue(outcomes, folder)
            for outcome in outcomes:
                row, = [line for line in made.splitlines() if line.startswith(f"| {outcome.claim['id']} |")]
                ending = {HOLDS: "| holds |", FAILS: "| **does not hold** |"}
                self.assertTrue(row.endswith(ending.get(outcome.verdict, "|")), row)

    def test_what_is_between_the_lines_is_replaced(self):
        text = f"before\n{BEGIN}\nold\n{END}\nafter\n"
        once = with_overview(text, "new")
        self.assertEqual(once, f"before\n{BEGIN}\n\nnew\n{END}\nafter\n")
        self.assertEqual(with_overview(once, "new"), once)
        with self.assertRaises(ResultsError):
            with_overview("no lines", "new")


if __name__ == "__main__":
    unittest.main()
