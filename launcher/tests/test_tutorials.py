# SPDX-License-Identifier: GPL-3.0-or-later
"""The tutorials in doc/ are run: files that they show are written, commands are given in their order."""

import os
import re
import tempfile
import unittest
from pathlib import Path

from .build_folder import BUILD, SOURCE, run

DOC = SOURCE / "doc"
# A line with a file's name before a fenced block, and the block with its language.
BLOCK = re.compile(r"(?:^`(?P<file>[^`\n]+)`:\n\n)?^```(?P<language>\w*)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)


def tutorials():
    """Names of the pages."""
    return sorted(path.stem for path in DOC.glob("*.md") if path.stem != "README")


def blocks(name):
    """(file or None, language, text) of a page's fenced blocks."""
    return [match.group("file", "language", "text")
            for match in BLOCK.finditer((DOC / f"{name}.md").read_text(encoding="utf-8"))]


class Tutorials(unittest.TestCase):
    def play(self, name):
        """Does what a page says, as one session of a shell; returns what that printed."""
        with tempfile.TemporaryDirectory() as temporary:
            script = ["set -eu"]
            for file, language, text in blocks(name):
                if file:
                    (Path(temporary) / file).write_text(text, encoding="utf-8")
                elif language == "sh":
                    script.append(text)
            self.assertGreater(len(script), 1, name)
            path = f"{BUILD / 'bin'}{os.pathsep}{os.environ['PATH']}"
            return run("bash", "-c", "\n".join(script), folder=temporary, PATH=path).stdout

    def test_index_names_every_page(self):
        index = re.findall(r"\]\(([\w-]+)\.md\)", (DOC / "README.md").read_text(encoding="utf-8"))
        self.assertEqual(sorted(index), tutorials())

    def test_reproduce_the_gear(self):
        shown = self.play("reproduce-the-gear")
        self.assertIn("Nothing has been written", shown)
        self.assertIn("iterations.csv", shown)

    def test_your_mesh_your_problem(self):
        self.assertIn("Smart Laplace", self.play("your-mesh-your-problem"))

    def test_smoother_in_cpp(self):
        shown = self.play("smoother-in-cpp")
        self.assertIn("100% tests passed", shown)
        self.assertIn("HalfLaplace", shown)

    def test_smoother_in_python(self):
        shown = self.play("smoother-in-python")
        self.assertIn("To centroids", shown)
        self.assertIn("mine", shown)

    def test_smoother_as_a_command(self):
        shown = self.play("smoother-as-a-command")
        self.assertIn("$ ", shown)
        self.assertIn("exit code 0", shown)

    def test_many_meshes_in_parts(self):
        shown = self.play("many-meshes-in-parts")
        self.assertRegex(shown, r"(?m)^broken\.sine,failed,")
        self.assertRegex(shown, r"(?m)^gear3\.smooth,complete,$")

    def test_smoothing_for_the_error(self):
        shown = self.play("smoothing-for-the-error")
        self.assertIn("Weights and descent", shown)
        self.assertIn("factors by which true errors fall", shown)

    def test_results_with_pandas(self):
        shown = self.play("results-with-pandas")
        self.assertRegex(shown, r"(?m)^tri +1 ")

    def test_into_latex(self):
        shown = self.play("into-latex")
        self.assertRegex(shown, r"history\S*\.pdf")


if __name__ == "__main__":
    unittest.main()
