# SPDX-License-Identifier: GPL-3.0-or-later
"""Location of the printed values; a package away from the repository makes the same."""

import contextlib
import io
import os
import shutil
import subprocess
import sys
from pathlib import Path
from unittest import mock

from plots.__main__ import main
from plots.results import data_folder as module
from plots.results.data_folder import THESIS, data_folder, thesis_folder
from plots.results.rows import ResultsError
from plots.tests.synthetic_results import write_results
from plots.tests.test_read_results import InFolder


def chosen(folder):
    """The environment variable for a block; without a folder it is not set."""
    others = {name: value for name, value in os.environ.items() if name != "SMOOTHFEM_DATA"}
    return mock.patch.dict(os.environ, {**others, **({"SMOOTHFEM_DATA": str(folder)} if folder else {})},
                           clear=True)


class DataFolder(InFolder):
    def with_data(self, *parts):
        """Makes a folder with the files that are searched for."""
        folder = self.folder.joinpath(*parts)
        (folder / THESIS).mkdir(parents=True)
        return folder

    def package(self, *parts):
        """Makes a folder count as that of the package."""
        return mock.patch.object(module, "PACKAGE", self.folder.joinpath(*parts))

    def test_order(self):
        below = self.with_data("opt", "share", "smoothfem")
        with chosen(None), self.package("opt", "lib", "python3", "plots"):
            self.assertEqual(data_folder(), below)
            above = self.with_data("opt", "lib", "python3")
            self.assertEqual(data_folder(), above)
            own = self.with_data("own")
            with chosen(own):
                self.assertEqual((data_folder(), thesis_folder()), (own, own / THESIS))
            with chosen(""):
                self.assertEqual(data_folder(), above)

    def test_one_sentence_where_there_are_none(self):
        for variable in ("", self.folder):
            with chosen(variable), self.package("plots"):
                with self.assertRaisesRegex(ResultsError, r"^[^\n]*SMOOTHFEM_DATA[^\n]*\.$"):
                    data_folder()
        errors = io.StringIO()
        with chosen(self.folder), contextlib.redirect_stderr(errors):
            self.assertEqual(main([str(write_results(self.folder / "r")), "--quiet"]), 2)
        self.assertEqual(errors.getvalue().count("\n"), 1)


class Installed(InFolder):
    def test_an_installed_package_makes_the_same_from_any_folder(self):
        source, shared = Path(module.__file__).resolve().parents[2], self.folder / "prefix/share/smoothfem"
        shutil.copytree(source / "plots", shared / "plots",
                        ignore=shutil.ignore_patterns("tests", "__pycache__"))
        shutil.copytree(thesis_folder(), shared / THESIS)
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        write_results(elsewhere / "r")
        expected = write_results(self.folder / "expected")
        chosen_figures = ("--only", "history,table*,claims")
        self.assertEqual(main([str(expected), "--quiet", *chosen_figures]), 0)
        with chosen(None):
            environment = {**os.environ, "PYTHONPATH": str(shared), "PYTHONDONTWRITEBYTECODE": "1"}
        done = subprocess.run([sys.executable, "-m", "plots", "r", "--verbose", *chosen_figures], cwd=elsewhere, env=environment,
                              capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("wrote r/tables/claims.md", done.stdout)
        for folder in ("tables", "figures"):
            found, made = ({path.name: path.read_bytes() for path in (parent / folder).iterdir()}
                           for parent in (elsewhere / "r", expected))
            self.assertEqual(found, made)
