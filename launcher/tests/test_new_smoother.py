# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of new-smoother build and run without changes, in each language. Invalid plugins are refused."""

import csv
import re
import tempfile
import unittest
from pathlib import Path

from .build_folder import BUILD, SMOOTHFEM, run

ABI_MARK = b"smoothfem plugin types:\0"


def rows(path):
    """Returns the rows of a CSV file as dictionaries."""
    with open(path, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def make(folder, name, *options):
    """Creates a new smoother below a folder; returns the smoother's folder."""
    shown = run(SMOOTHFEM, "new-smoother", name, *options, folder=folder).stdout
    if f"{name}/README.md says what to do next:" not in shown:
        raise AssertionError(shown)
    for path in (folder / name).iterdir():
        if re.search(r"@\w+@", path.read_text(encoding="utf-8")):
            raise AssertionError(f"{path} has a mark that is not filled in")
    return folder / name


class NewSmoother(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """Builds the smoother in C++ once."""
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.built = make(Path(temporary.name), "ab-cd")
        run("cmake", "-S", ".", "-B", "build", "-DCMAKE_BUILD_TYPE=Debug", folder=cls.built)
        run("cmake", "--build", "build", folder=cls.built)
        cls.library = cls.built / "libab_cd.so"

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def study(self, folder, name):
        """Returns the rows of summary.csv of the generated study."""
        run(SMOOTHFEM, "study", f"{name}.prm", "--quiet", "--no-figures", folder=folder)
        found = rows(folder / "results" / name / "summary.csv")
        mine = [row for row in found if row["method"] == name]
        self.assertEqual({row["status"] for row in mine}, {"ok"})
        self.assertEqual(len(mine), 2)
        before = {row["mesh"]: float(row["q_mean"]) for row in found if row["method"] == "initial"}
        for row in mine:
            self.assertGreater(float(row["q_mean"]), before[row["mesh"]])
        tables = "".join(path.read_text() for path in (folder / "results" / name / "tables").glob("*.md"))
        self.assertIn(name, tables.replace("AbCd", name))

    def test_cpp(self):
        folder = self.built
        told = run("ctest", "--test-dir", "build", "--output-on-failure", folder=folder).stdout
        self.assertIn("100% tests passed", told)
        self.assertIn("\n  ab-cd: AbCd\n", run(SMOOTHFEM, "list", "--plugin", "./libab_cd.so", folder=folder).stdout)
        self.study(folder, "ab-cd")
        provenance = (folder / "results" / "ab-cd" / "provenance.json").read_text()
        self.assertRegex(provenance, r'"name": "libab_cd.so",\s+"sha256": "[0-9a-f]{64}"')
        self.assertNotIn(str(folder), provenance)

    def test_python(self):
        folder = make(self.folder, "ab-cd", "--python")
        run("sh", "test.sh", SMOOTHFEM, folder=folder)
        self.study(folder, "ab-cd")

    def test_command(self):
        folder = make(self.folder, "ab-cd", "--command")
        run("sh", "test.sh", SMOOTHFEM, folder=folder)
        self.study(folder, "ab-cd")
        self.assertTrue((folder / "results" / "ab-cd" / "logs" / "tri_ab-cd.log").is_file())

    def refused(self, *words):
        """Returns the line that a refused command prints."""
        outcome = run(SMOOTHFEM, *words, folder=self.folder, check=False)
        self.assertEqual((outcome.returncode, outcome.stderr.count("\n")), (2, 1), outcome.stderr)
        return outcome.stderr

    def test_names_that_cannot_be(self):
        (self.folder / "here").mkdir()
        self.assertIn("use lower-case letters", self.refused("new-smoother", "Ab_cd"))
        self.assertIn("'here' exists here", self.refused("new-smoother", "here"))
        self.assertIn("a method 'laplace' exists", self.refused("new-smoother", "laplace"))

    def test_plugins_that_are_none(self):
        self.assertIn("there is no plugin none.so", self.refused("list", "--plugin", "none.so"))
        (self.folder / "text.so").write_text("text")
        self.assertIn("is not a shared library", self.refused("list", "--plugin", "text.so"))
        other = next(BUILD.glob("lib/libsmoothfem_fem.so*"))
        self.assertIn("is not a plugin of smoothfem", self.refused("list", "--plugin", other))
        library = self.library
        good = library.read_bytes()
        at = good.index(ABI_MARK) + len(ABI_MARK)
        (self.folder / "old.so").write_bytes(re.sub(re.escape(good[at - len(ABI_MARK):at + 4]),
                                                    ABI_MARK + b"\xff\0\0\0", good))
        self.assertIn("was built against another smoothfem", self.refused("list", "--plugin", "old.so"))
        (self.folder / "half.so").write_bytes(good[:len(good) * 3 // 4])
        self.assertIn("is incomplete", self.refused("list", "--plugin", "half.so"))
        copy = self.folder / "copy.so"
        copy.write_bytes(good)
        self.assertIn("'ab-cd'", self.refused("list", "--plugin", library, "--plugin", copy))


if __name__ == "__main__":
    unittest.main()
