# SPDX-License-Identifier: GPL-3.0-or-later
"""LaTeX compiles the document of docs/how-to/latex.md with figures and tables made by the commands of that page."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from unittest import mock

from plots.__main__ import main
from plots.tests.synthetic_results import write_results
from plots.tests.test_read_results import InFolder

PAGE = Path(__file__).resolve().parents[2] / "docs" / "how-to" / "latex.md"
PACKAGES = ("booktabs.sty", "graphicx.sty")
PROGRAM = shutil.which("pdflatex")


def what_is_missing():
    """A sentence if LaTeX is not complete here."""
    if PROGRAM is None:
        return "pdflatex is not installed"
    absent = [name for name in PACKAGES if not subprocess.run(["kpsewhich", name], capture_output=True, check=False).stdout.strip()]
    return f"LaTeX has no {', '.join(absent)}" if absent else ""


class Latex(InFolder):
    def setUp(self):
        super().setUp()
        if missing := what_is_missing():
            print(f"\nSKIPPED: {missing}, so nothing tests that figures and tables fit LaTeX; install the Debian package "
                  "texlive-latex-recommended.", file=sys.stderr)
            self.skipTest(missing)
        here = os.getcwd()
        self.addCleanup(os.chdir, here)
        os.chdir(self.folder)
        write_results(self.folder / "results" / "gear", meshes=("tri", "quad"),
                      methods=("weighted-laplace", "smart-laplace", "getme", "own_1"))

    def compile(self, name):
        """The log of the second run of LaTeX, when references are known. It ends at the first error."""
        for _ in range(2):
            done = subprocess.run([PROGRAM, "-halt-on-error", "-interaction=nonstopmode", name], capture_output=True, text=True,
                                  encoding="utf-8", errors="replace", check=False)
            self.assertEqual(done.returncode, 0, done.stdout[-2000:])
        self.assertEqual(Path(name).with_suffix(".pdf").read_bytes()[:4], b"%PDF")
        return Path(name).with_suffix(".log").read_text(encoding="utf-8", errors="replace")

    @mock.patch("plots.figures.style.DPI", 40)
    def test_document_of_the_manual(self):
        text = PAGE.read_text(encoding="utf-8")
        commands = [shlex.split(line)[2:] for line in re.findall("^smoothfem plot .*$", text, re.MULTILINE)]
        self.assertEqual(len(commands), 4)
        for command in commands:
            self.assertEqual(main(command), 0, command)
        self.assertEqual(main(["results/gear", "--no-figures", "--quiet"]), 0)  # as the study has done
        name, document = re.search(r"^`(\w+\.tex)`:\n\n```tex\n(.*?)^```$", text, re.MULTILINE | re.DOTALL).groups()
        Path(name).write_text(document, encoding="utf-8")
        log = self.compile(name)
        self.assertNotRegex(log, "undefined|Overfull|multiply defined")
        self.assertIn("error.pdf", log)

    def test_all_tables(self):
        self.assertEqual(main(["results/gear", "--no-figures", "--quiet"]), 0)
        tables = sorted(Path("results/gear/tables").glob("*.tex"))
        self.assertEqual(len(tables), 5)
        Path("all.tex").write_text(r"\documentclass{article}\usepackage{booktabs,graphicx}\begin{document}" + "\n".join(
            rf"\input{{{path}}}" for path in tables) + r"\end{document}", encoding="utf-8")
        self.assertNotRegex(self.compile("all.tex"), "undefined|Overfull|multiply defined")
