# SPDX-License-Identifier: GPL-3.0-or-later
"""Notes on rounding below the gear's tables agree with the results of its study."""

import unittest

from plots.claims.reasons import reference
from plots.results.data_folder import thesis_folder
from plots.results.rows import read_rows

REASON = "studies/reasons/gear-rounding.prm"


def notes():
    """Table -> note."""
    return {row["table"]: row["note"] for row in read_rows(thesis_folder() / "deviations.csv").records()
            if row["known_from"] == REASON}


class Rounding(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.found = read_rows(reference() / "reasons" / "gear-rounding" / "iterations.csv").records()

    def numbers(self, mesh, degree, column):
        """Numbers of the original mesh, then of the changed ones."""
        return [float(row[column]) for row in self.found if (row["mesh"], row["degree"]) == (mesh, degree)]

    @staticmethod
    def printed(table, mesh, degree, column):
        return next(float(row[column]) for row in read_rows(thesis_folder() / f"table_{table}.csv").records()
                    if (row["mesh"], row["degree"], row["method"]) == (mesh, degree, "initial"))

    def test_counts(self):
        self.assertIn("twenty changes of the initial meshes by last bits move theirs by 1 to 5 %", notes()["6.2"])
        self.assertIn("counts of degree 2 are among these, those of degree 1 are up to 3 % above them", notes()["6.2"])
        above = []
        for mesh in ("tri", "quad"):
            for degree in ("1", "2"):
                counts = self.numbers(mesh, degree, "cg_iterations")
                self.assertEqual(len(counts), 1 + 20)
                self.assertTrue(.01 <= max(counts) / min(counts) - 1 <= .05, (mesh, degree))
                printed = self.printed("6_2", mesh, degree, "cg_iterations")
                if degree == "2":
                    self.assertTrue(min(counts) <= printed <= max(counts), mesh)
                else:
                    above.append(printed / max(counts) - 1)
        self.assertTrue(0 < min(above) and .025 <= max(above) <= .03, above)

    def test_errors(self):
        self.assertIn("move e_mean by 1.5 % and e_L2 by 0.4 %, more than either differs from the printed value, "
                      "which is not among them", notes()["6.3"])
        for column, percent in (("e_mean", 1.5), ("e_l2", .4)):
            errors = self.numbers("tri", "2", column)
            spread = max(errors) / min(errors) - 1
            self.assertAlmostEqual(100 * spread, percent, delta=.05)
            printed = self.printed("6_3", "tri", "2", column)
            self.assertGreater(spread, abs(printed / errors[0] - 1))
            self.assertFalse(min(errors) <= printed <= max(errors))
