# SPDX-License-Identifier: GPL-3.0-or-later
"""The generated blocks of README.md, docs/ and paper/ are those of the results, and columns.json agrees with the program."""

import json
import re
import tempfile
import unittest
from pathlib import Path

from plots.claims.overview import studies
from plots.claims.reasons import reference
from plots.manual.blocks import begin, end, table, updated
from plots.manual.fidelity import CAUSES, causes, failing, read_causes
from plots.manual.pages import blocks
from plots.results.data_folder import data_folder
from plots.results.rows import ResultsError, read_rows

HOW = "run python3 -m plots.manual"


def source(path, pattern):
    """The first group of a pattern in a source."""
    return re.search(pattern, (data_folder() / path).read_text(encoding="utf-8"))[1]


class Blocks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.blocks = blocks()

    def test_pages_are_up_to_date(self):
        for path, made in self.blocks.items():
            with self.subTest(path.name):
                self.assertEqual(path.read_text(encoding="utf-8"), updated(path, made), HOW)

    def test_no_page_has_another_block(self):
        known = {path: set(made) for path, made in self.blocks.items()}
        for path in (data_folder() / "README.md", data_folder() / "paper" / "paper.md", *(data_folder() / "docs").rglob("*.md")):
            found = re.findall(r"<!-- begin (\S+): made by", path.read_text(encoding="utf-8"))
            self.assertEqual(sorted(found), sorted(known.get(path, ())), path)

    def test_only_the_block_is_replaced(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "page.md"
            path.write_text(f"before\n{begin('a')}\nold\n{end('a')}\nafter\n")
            once = updated(path, {"a": "new\n"})
            self.assertEqual(once, f"before\n{begin('a')}\n\nnew\n\n{end('a')}\nafter\n")
            path.write_text(once)
            self.assertEqual(updated(path, {"a": "new"}), once)
            path.write_text("no lines")
            with self.assertRaisesRegex(ResultsError, re.escape(str(path))):
                updated(path, {"a": "new"})

    def test_table(self):
        self.assertEqual(table(("a", "b"), [(1, 2)], "lr"), "| a | b |\n| :-- | --: |\n| 1 | 2 |")


class Causes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.studies = studies(reference())

    def test_every_claim_that_does_not_hold_has_a_cause(self):
        self.assertEqual(sorted(read_causes()), sorted(failing(self.studies)))
        self.assertEqual(set(read_causes().values()), set(CAUSES))

    def test_a_claim_without_cause_is_an_error(self):
        with self.assertRaisesRegex(ResultsError, "these claims differ"):
            causes(self.studies[:1])

    def test_claims_on_the_published_gears_fail_for_times_and_the_optimizer_only(self):
        gear, = [study for study in self.studies if study.name == "gear"]
        self.assertLessEqual({read_causes()[name] for name in failing([gear])}, {"optimizer", "speed"})


class Columns(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.json = json.loads((data_folder() / "studies" / "columns.json").read_text(encoding="utf-8"))

    def meaning(self, column):
        """The text on a column."""
        return self.json["columns"][column]["meaning"]

    def test_each_column_is_described_once_and_used(self):
        used = {name for file in self.json["files"].values() for name in file["columns"]}
        self.assertEqual(used, set(self.json["columns"]))
        for name, file in self.json["files"].items():
            self.assertLessEqual(set(file.get("here", {})), set(file["columns"]), name)
            self.assertEqual(len(file["columns"]), len(set(file["columns"])), name)

    def test_constants_are_those_of_the_program(self):
        rows = source("fem/linear_algebra/condition_number.h", r"dense_limit = (\d+)")
        self.assertIn(f"matrices of up to {rows} rows", self.meaning("condition_method"))
        tolerance = source("studies/catalogue/thesis/gear.prm", r"cg tolerance *= (\S+)")
        self.assertIn(f"<= {tolerance} |b|", self.meaning("cg_iterations"))
        margin = float(source("studies/catalogue/thesis/gear.prm", r"margin *= (\S+)"))
        self.assertEqual(self.json["columns"]["threshold"]["source"], f"Table 6.4: {100 * margin:.0f} %")

    def test_residuals_of_eigenvalues_are_below_the_bound(self):
        bound = float(re.search(r"below (\S+), except for `cg-lanczos`", self.meaning("condition_residual"))[1])
        for path in reference().glob("*/summary.csv"):
            rows = read_rows(path)
            known = rows.where((rows.text("condition_residual") != "") & (rows.text("condition_method") != "cg-lanczos"))
            self.assertTrue((known.number("condition_residual") < bound).all(), path)

    def test_reference_results_have_these_columns(self):
        described = set(self.json["columns"])
        for path in reference().glob("*/*.csv"):
            if path.name in self.json["files"]:
                names = [name for name in read_rows(path).columns if not re.match(r"n_(star_)?below_", name)]
                self.assertLessEqual(set(names), described, path)


if __name__ == "__main__":
    unittest.main()
