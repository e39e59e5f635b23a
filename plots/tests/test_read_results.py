# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading of CSV files, and messages about broken ones."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

from plots.__main__ import main
from plots.results.smoothing import read_results
from plots.tests.synthetic_results import write_csv, write_results


class InFolder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)


class ReadResults(InFolder):
    def message_of(self, folder):
        """The message on stderr of a run that must end with exit code 2."""
        errors = io.StringIO()
        with contextlib.redirect_stderr(errors):
            self.assertEqual(main([str(folder), "--quiet", "--no-figures"]), 2)
        return errors.getvalue()

    def test_orders_and_titles(self):
        results = read_results(write_results(self.folder / "r", methods=("own", "getme")))
        self.assertEqual(results.methods, ("getme", "own"))  # the provenance knows getme only
        self.assertEqual(results.degrees, ("1", "2"))
        self.assertEqual(results.title("getme"), "GETMe")
        self.assertEqual(results.title("own"), "own")

    def test_order_of_columns_does_not_matter(self):
        folder = write_results(self.folder / "r")
        before = read_results(folder).summary.records()
        write_csv(folder / "summary.csv", sorted(before[0]), before)
        self.assertEqual(read_results(folder).summary.records(), before)

    def test_files_that_may_be_absent(self):
        folder = write_results(self.folder / "r")
        (folder / "thresholds.csv").unlink()
        (folder / "provenance.json").unlink()
        results = read_results(folder)
        self.assertEqual((results.study, len(results.thresholds)), ("gear", 0))

    def test_missing_file_and_folder(self):
        folder = write_results(self.folder / "r")
        (folder / "summary.csv").unlink()
        self.assertIn("summary.csv: the file is missing", self.message_of(folder))
        self.assertIn("no such folder", self.message_of(self.folder / "nowhere"))

    def test_broken_files(self):
        for name, old, new, said in (
                ("iterations.csv", "e_mean", "e_other", "column `e_mean` is missing"),
                ("summary.csv", "377.4", "many", "not a number"),
                ("provenance.json", "}", "", "not a complete JSON file")):
            folder = write_results(self.folder / name)
            path = folder / name
            path.write_text(path.read_text().replace(old, new))
            message = self.message_of(folder)
            self.assertIn(said, message)
            self.assertEqual(message.count("\n"), 1)

    def test_truncated_row(self):
        folder = write_results(self.folder / "r")
        path = folder / "iterations.csv"
        path.write_text(path.read_text()[:-40])
        self.assertIn("truncated", self.message_of(folder))
