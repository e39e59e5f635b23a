# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables in results/reference are those that their CSV files make."""

import tempfile
import unittest
from pathlib import Path

from plots.__main__ import main
from plots.claims.reasons import reference


def contents(folder):
    """Name -> bytes of the files in a folder."""
    return {path.name: path.read_bytes() for path in folder.iterdir()}


class ReferenceTables(unittest.TestCase):
    def test_they_are_made_from_the_csv_files_there_are(self):
        folders = sorted(path.parent for path in reference().glob("*/tables"))
        self.assertEqual({path.parent for path in reference().glob("*/summary.csv")}, set(folders))
        self.assertGreater(len(folders), 1)
        for folder in folders:
            with tempfile.TemporaryDirectory() as out:
                self.assertEqual(main([str(folder), "--quiet", "--no-figures", "--out", out]), 0)
                made, there = contents(Path(out) / "tables"), contents(folder / "tables")
            self.assertEqual(set(made), set(there), f"{folder.name}: run python3 -m plots {folder} --no-figures")
            for name, content in made.items():
                self.assertEqual(content.decode(), there[name].decode(), f"{folder.name}/tables/{name}")
