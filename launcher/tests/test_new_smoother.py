# SPDX-License-Identifier: GPL-3.0-or-later
"""What new-smoother and new-problem make runs at once. launcher/tests/test_installed.py builds and runs the smoother in C++, and
docs/tests/test_pages.py the solver in C++."""

import csv
import re
import tempfile
import unittest
from pathlib import Path

from .build_folder import SMOOTHFEM, run


def rows(path):
    """Returns the rows of a CSV file as dictionaries."""
    with open(path, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def make(folder, name, *options, smoothfem=SMOOTHFEM, command="new-smoother"):
    """Makes a new smoother, or a problem, below a folder; returns its own folder."""
    shown = run(smoothfem, command, name, *options, folder=folder).stdout
    if f"{name}/README.md says what to do next:" not in shown:
        raise AssertionError(shown)
    for path in (folder / name).iterdir():
        if re.search(r"@\w+@", path.read_text(encoding="utf-8")):
            raise AssertionError(f"{path} has a mark that is not filled in")
    return folder / name


class Study:
    """For tests of a folder that new-smoother has made."""

    smoothfem = SMOOTHFEM

    def study(self, folder, name):
        """Rows of the summary of the study that comes with it."""
        run(self.smoothfem, "study", f"{name}.prm", "--quiet", "--no-figures", folder=folder)
        found = rows(folder / "results" / name / "summary.csv")
        mine = [row for row in found if row["method"] == name]
        self.assertEqual({row["status"] for row in mine}, {"ok"})
        self.assertEqual(len(mine), 2)
        before = {row["mesh"]: float(row["q_mean"]) for row in found if row["method"] == "initial"}
        for row in mine:
            self.assertGreater(float(row["q_mean"]), before[row["mesh"]])
        tables = "".join(path.read_text() for path in (folder / "results" / name / "tables").glob("*.md"))
        self.assertIn(name, tables.replace("AbCd", name))

    def refused(self, *words):
        """The one line that a refused command prints."""
        outcome = run(self.smoothfem, *words, folder=self.folder, check=False)
        self.assertEqual((outcome.returncode, outcome.stderr.count("\n")), (2, 1), outcome.stderr)
        return outcome.stderr


class NewSmoother(Study, unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def test_python(self):
        folder = make(self.folder, "ab-cd", "--python")
        run("sh", "test.sh", SMOOTHFEM, folder=folder)
        self.study(folder, "ab-cd")

    def test_command(self):
        folder = make(self.folder, "ab-cd", "--command")
        run("sh", "test.sh", SMOOTHFEM, folder=folder)
        self.study(folder, "ab-cd")
        self.assertTrue((folder / "results" / "ab-cd" / "logs" / "tri_ab-cd.log").is_file())

    def test_problem_in_python(self):
        folder = make(self.folder, "ab-cd", "--python", command="new-problem")
        run("sh", "test.sh", SMOOTHFEM, folder=folder)

    def test_names_that_cannot_be(self):
        (self.folder / "here").mkdir()
        self.assertIn("use at most 100 lower-case letters", self.refused("new-smoother", "Ab_cd"))
        self.assertIn("'here' exists here", self.refused("new-smoother", "here"))
        self.assertIn("a method 'laplace' exists", self.refused("new-smoother", "laplace"))


if __name__ == "__main__":
    unittest.main()
