# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs studies by the program, so that their results do not depend on Python, and reads the results as tables of pandas."""

import functools
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

from ._core import InputError

PREFIX = "smoothfem: "  # of the program's messages


class Study:
    """A study, given by its file or the name of a built-in study, with an optional scale."""

    def __init__(self, file, scale=None):
        self.file, self.scale = os.fspath(file), scale

    @property
    def name(self):
        """Returns the file's name without its suffix."""
        return Path(self.file).name.removesuffix(".prm")

    def run(self, out=None, *, force=False, mesh_dir=None, threads=None, smoothing_threads=None, quiet=True):
        """Runs the study in a separate process, and returns its Results.

        out: folder of the results (default: results/NAME). A complete study in it is not changed; an interrupted study
        resumes. force: start again; the folder is renamed and kept. mesh_dir: folder of published meshes. threads,
        smoothing_threads: the options of the program. quiet: if False, progress is printed to standard error. Raises
        InputError with the program's message if an input cannot be used. After Ctrl-C the program writes the rows
        that are complete.
        """
        out = Path(out or Path("results") / self.name)
        words = [_program(), "study", self.file, "--out", out]
        for option, value in (("--scale", self.scale), ("--mesh-dir", mesh_dir), ("--threads", threads),
                              ("--smoothing-threads", smoothing_threads)):
            words += [option, value] if value is not None else []
        words += ["--force"] * force + ["--quiet"] * quiet
        _run([str(word) for word in words], quiet)
        return Results(out)


class Results:
    """The folder of a study's results. Tables are DataFrames of pandas (Debian: python3-pandas)."""

    def __init__(self, folder):
        self.folder = Path(folder)
        if not (self.folder / "provenance.json").is_file():
            raise InputError(f"{self.folder} has no results of a study, as provenance.json is missing")

    def __repr__(self):
        return f"<smoothfem.Results: {self.folder}>"

    def table(self, name):
        """Returns NAME.csv of the folder. Raises InputError if there is none, ImportError without pandas."""
        path = self.folder / f"{name}.csv"
        if not path.is_file():
            names = ", ".join(sorted(found.stem for found in self.folder.glob("*.csv"))) or "none"
            raise InputError(f"{self.folder} has no table '{name}'; it has {names}")
        return _pandas().read_csv(path)

    @functools.cached_property
    def iterations(self):
        """Returns a row for each mesh, method, degree and recorded iteration; `smoothfem list --columns` describes the columns."""
        return self.table("iterations")

    @functools.cached_property
    def summary(self):
        """Returns the results: a row for each mesh, method and degree."""
        return self.table("summary")

    @functools.cached_property
    def thresholds(self):
        """Returns the times at which methods fall below the errors of the reference method."""
        return self.table("thresholds")

    @functools.cached_property
    def provenance(self):
        """Returns the origin of the numbers: program, machine, meshes, parameters."""
        return json.loads((self.folder / "provenance.json").read_text(encoding="utf-8"))


def _pandas():
    try:
        import pandas
    except ImportError as error:
        raise ImportError("tables of results need pandas; on Debian: apt install python3-pandas") from error
    return pandas


def _program():
    """Returns the path of the compiled program in the installation or build folder of this package."""
    for folder in Path(__file__).absolute().parents:  # links of the build folder are not followed
        if (program := folder / "libexec" / "smoothfem" / "smoothfem").is_file():
            return program
    raise InputError(f"the program libexec/smoothfem/smoothfem is in no folder above {__file__}; install smoothfem again")


def _run(words, quiet):
    """Runs the program; passes the first interrupt on to it."""
    said = []
    with subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                          text=True, start_new_session=True) as process:
        try:
            for line in process.stderr:
                said.append(line.strip())
                if not quiet:
                    sys.stderr.write(line)
            code = process.wait()
        except KeyboardInterrupt:
            process.send_signal(signal.SIGINT)
            process.communicate()
            raise
    if code == 2:
        raise InputError(said[-1].removeprefix(PREFIX) if said else "the program refuses the study")
    if code != 0:
        raise RuntimeError(f"the study ended with code {code}: " + " ".join(said[-3:]))
