# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparison of a study that was run again with the numbers of its reference."""

import lzma
import tempfile
import unittest
from pathlib import Path

from plots.results import same_numbers

ITERATIONS = "mesh,iteration,smoothing_seconds,q_min\ntri,0,0.1,0.25\ntri,1,0.2,0.5\n"
SUMMARY = "mesh,method,smoothing_seconds,peak_memory_gib,q_min\ntri,getme,0.2,1.5,0.5\n"


class SameNumbers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.reference, self.results = Path(folder.name) / "reference", Path(folder.name) / "results"
        for one in (self.reference, self.results):
            one.mkdir()
            (one / "iterations.csv").write_text(ITERATIONS)
            (one / "summary.csv").write_text(SUMMARY)

    def differences(self):
        return same_numbers.differences(self.reference, self.results)

    def test_same_numbers_are_the_same(self):
        self.assertEqual(self.differences(), (3, []))

    def test_times_and_memory_are_the_machines(self):
        (self.results / "iterations.csv").write_text(ITERATIONS.replace(",0.2,", ",0.4,"))
        (self.results / "summary.csv").write_text(SUMMARY.replace("1.5", "3"))
        self.assertEqual(self.differences(), (3, []))

    def test_the_last_digit_counts(self):
        (self.results / "iterations.csv").write_text(ITERATIONS.replace("0.25", "0.250000000000001"))
        self.assertEqual(self.differences(),
                         (3, ["iterations.csv, row 1: q_min 0.25 in the reference, now 0.250000000000001"]))

    def test_rows_that_only_one_has_differ(self):
        (self.results / "iterations.csv").write_text(ITERATIONS + "tri,2,0.3,0.6\n")
        self.assertEqual(self.differences(), (3, ["iterations.csv, row 3: only in the results"]))
        (self.results / "iterations.csv").unlink()
        self.assertEqual(self.differences()[1], [f"iterations.csv, row {i}: only in the reference" for i in (1, 2)])

    def test_columns_of_one_version_alone_are_not_looked_at(self):
        (self.results / "summary.csv").write_text("mesh,method,n_solves,q_min\ntri,getme,3,0.5\n")
        self.assertEqual(self.differences(), (3, []))

    def test_packed_tables_are_read(self):
        (self.reference / "iterations.csv").unlink()
        (self.reference / "iterations.csv.xz").write_bytes(lzma.compress(ITERATIONS.replace("0.5", "0.6").encode()))
        self.assertEqual(self.differences()[1], ["iterations.csv, row 2: q_min 0.6 in the reference, now 0.5"])

    def test_records_are_kept_by_study_until_its_reference_is_new(self):
        for study, commit, different in (("ring", "a", 0), ("gear", "a", 2), ("ring", "b", 1)):
            same_numbers.keep_record(self.reference, study, commit, "c", 7, different)
        found = same_numbers.read_records(self.reference)
        self.assertEqual([(study, row["commit"], row["again"], row["rows"], row["different"]) for study, row in found.items()],
                         [("gear", "a", "c", "7", "2"), ("ring", "b", "c", "7", "1")])
        same_numbers.drop_record(self.reference, "gear")
        same_numbers.drop_record(self.reference, "sphere")
        self.assertEqual(list(same_numbers.read_records(self.reference)), ["ring"])


if __name__ == "__main__":
    unittest.main()
