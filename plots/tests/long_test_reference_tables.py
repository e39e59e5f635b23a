# SPDX-License-Identifier: GPL-3.0-or-later
"""`smoothfem plot` makes the tables of every study in results/reference from the packed rows."""

import tempfile
import unittest
from pathlib import Path

from plots.__main__ import main
from plots.claims.reasons import reference
from plots.results.rows import is_there


class ReferenceTables(unittest.TestCase):
    def test_tables_are_made_from_the_rows(self):
        folders = [path.parent for path in sorted(reference().rglob("provenance.json"))
                   if not is_there(path.parent / "members.csv")]  # the records of collections are not kept
        self.assertGreater(len(folders), 50)
        for folder in folders:
            with self.subTest(folder.name), tempfile.TemporaryDirectory() as out:
                self.assertEqual(main([str(folder), "--quiet", "--no-figures", "--out", out]), 0)
                tables = list((Path(out) / "tables").glob("*.csv"))
                self.assertTrue(tables)
                for table in tables:
                    self.assertGreater(len(table.read_text(encoding="utf-8").splitlines()), 1, table.name)
