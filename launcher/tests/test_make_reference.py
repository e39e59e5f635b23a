# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests what `./run reference` refuses (one sentence, exit code 2, no files), and which references it assigns to the program of a
commit."""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from plots.results.same_numbers import read_records

SOURCE = Path(__file__).resolve().parents[2]


def run_script(source, work, *words):
    """Runs the script with arguments after the paths, as ./run does."""
    command = [sys.executable, "-B", SOURCE / "tools" / "make_reference.py", source, "no-program", work, *words]
    return subprocess.run(command, capture_output=True, text=True, check=False, env={**os.environ, "PYTHONPATH": str(SOURCE)})


class MakeReference(unittest.TestCase):
    def refused(self, source, work, *words):
        """Returns the message for arguments that the script refuses."""
        found = run_script(source, work, *words)
        self.assertEqual((found.returncode, found.stdout), (2, ""), found.stderr)
        self.assertEqual(len(found.stderr.splitlines()), 1, found.stderr)
        self.assertEqual(list(work.iterdir()), [])
        return found.stderr

    def test_studies_that_there_are_not_or_that_have_no_reference(self):
        with tempfile.TemporaryDirectory() as folder:
            source, work = Path(folder) / "source", Path(folder) / "work"
            source.mkdir()
            work.mkdir()
            (source / "studies").symlink_to(SOURCE / "studies")
            for words in (("nosuch",), ("--compare", "nosuch"), ("nosuch", "--compare")):
                self.assertRegex(self.refused(source, work, *words), "^reference: there is no study 'nosuch'.*ring")
            self.assertRegex(self.refused(source, work, "--compare", "ring"), "^reference: 'ring' has no reference")
            self.assertEqual([path.name for path in source.iterdir()], ["studies"])


class ProgramOf(unittest.TestCase):
    """Tests a repository with one source file, a test, the study a, and the study b, which includes a."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.source = Path(folder.name)
        self.git("init", "--quiet")
        for name, text in (("x/f.cc", "1"), ("x/tests/test_f.cc", "1"),
                           ("studies/reasons/c.prm", "include ../catalogue/x/a.prm\n"),
                           ("studies/catalogue/x/a.prm", "subsection scale paper\n"),
                           ("studies/catalogue/x/b.prm", "include a.prm\n"),
                           ("studies/catalogue/x/d.prm", "subsection scale paper\n" * 9)):
            self.write(name, text)
        self.first = self.commit()
        for study in ("a", "b", "reasons/c"):
            self.write_reference(study, uncommitted_changes=study == "a")

    def git(self, *words):
        return subprocess.run(["git", "-C", self.source, "-c", "user.name=t", "-c", "user.email=t@localhost", *words],
                              capture_output=True, text=True, check=True).stdout.strip()

    def write(self, name, text):
        (self.source / name).parent.mkdir(parents=True, exist_ok=True)
        (self.source / name).write_text(text)

    def write_reference(self, study, uncommitted_changes=False):
        self.write(f"results/reference/{study}/provenance.json", json.dumps({
            "program": {"commit": self.first}, "sessions": [{"commit": self.first, "uncommitted_changes": uncommitted_changes}]}))

    def commit(self):
        self.git("add", "x", "studies")
        self.git("commit", "--quiet", "-m", "t")
        return self.git("rev-parse", "HEAD")

    def of_program(self, commit):
        """Returns the studies that the script assigns to a commit's program."""
        found = run_script(self.source, self.source, "--program-of", commit)
        self.assertEqual((found.returncode, found.stderr), (0, ""))
        records = read_records(self.source / "results" / "reference")
        for row in records.values():
            self.assertEqual((row["commit"], row["rows"], row["different"]), (self.first, "", "0"))
        return sorted(study for study, row in records.items() if row["again"] == commit)

    def test_another_test_is_the_same_program(self):
        self.write("x/tests/test_f.cc", "2")
        self.write("studies/catalogue/x/new.prm", "subsection scale paper\n")
        self.assertEqual(self.of_program(self.commit()), ["b", "reasons/c"])

    def test_other_sources_and_other_studies_are_not(self):
        self.write("studies/catalogue/x/b.prm", "include a.prm\nset threads = 2\n")
        self.assertEqual(self.of_program(self.commit()), ["reasons/c"])
        self.write("studies/catalogue/x/a.prm", "subsection scale paper\nset threads = 2\n")
        self.assertEqual(self.of_program(self.commit()), [])
        self.write("x/f.cc", "2")
        self.assertEqual(self.of_program(self.commit()), [])

    def test_a_moved_study_is_the_same_until_it_changes(self):
        self.write_reference("d")
        (self.source / "studies/catalogue/x/d.prm").unlink()
        self.write("studies/catalogue/y/d.prm", "subsection scale paper\n" * 9)
        self.assertEqual(self.of_program(self.commit()), ["b", "d", "reasons/c"])
        self.write("studies/catalogue/y/d.prm", "subsection scale paper\n" * 9 + "set threads = 2\n")
        self.assertEqual(self.of_program(self.commit()), ["b", "reasons/c"])

    def test_a_commit_that_there_is_not(self):
        found = run_script(self.source, self.source, "--program-of", "nosuch")
        self.assertEqual((found.returncode, found.stdout), (2, ""))
        self.assertRegex(found.stderr, "^reference: there is no commit 'nosuch'")

    def test_a_reference_of_a_commit_that_is_not_in_the_history(self):
        commit = "1" * 40
        self.write("results/reference/b/provenance.json", json.dumps({
            "program": {"commit": commit}, "sessions": [{"commit": commit, "uncommitted_changes": False}]}))
        found = run_script(self.source, self.source, "--program-of", self.first, "b")
        self.assertEqual((found.returncode, found.stdout, len(found.stderr.splitlines())), (2, "", 1), found.stderr)
        self.assertRegex(found.stderr, f"^reference: there is no commit '{commit}'")
        self.assertFalse((self.source / "results" / "reference" / "again.csv").exists())


if __name__ == "__main__":
    unittest.main()
