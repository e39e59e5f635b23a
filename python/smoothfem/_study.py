# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies: run by the program itself, so that they are what they are without Python; their results as
tables of pandas."""

import functools
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

from ._core import InputError

PREFIX = "smoothfem: "  # of what the program says


class Study:
    """A study file, or the name of a study that comes with the program; a scale of it, or none."""

    def __init__(self, file, scale=None):
        self.file, self.scale = os.fspath(file), scale

    @property
    def name(self):
        """The file's name without its ending."""
        return Path(self.file).name.removesuffix(".prm")

    def run(self, out=None, *, force=False, mesh_dir=None, threads=None, smoothing_threads=None, quiet=True):
        """Runs the study in one process of its own, and returns its Results.

        out: folder of the results, results/NAME unless given; a complete study in it is left as it is, an
        interrupted one goes on. force: start anew; the folder is kept under another name. mesh_dir: folder
        of published meshes. threads, smoothing_threads: as the program's options. quiet: otherwise progress
        goes to standard error. Raises InputError with the program's sentence for what cannot be used;
        Ctrl-C lets the program write the rows finished so far.
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
            raise InputError(f"{self.folder} has no results of a study: provenance.json is missing")

    def __repr__(self):
        return f"<smoothfem.Results: {self.folder}>"

    def table(self, name):
        """NAME.csv of the folder. Raises InputError if there is none, ImportError without pandas."""
        path = self.folder / f"{name}.csv"
        if not path.is_file():
            names = ", ".join(sorted(found.stem for found in self.folder.glob("*.csv"))) or "none"
            raise InputError(f"{self.folder} has no table '{name}'; it has {names}")
        return _pandas().read_csv(path)

    @functools.cached_property
    def iterations(self):
        """A row for each mesh, method, degree and recorded iteration; `smoothfem list --columns` describes the columns."""
        return self.table("iterations")

    @functools.cached_property
    def summary(self):
        """A row for each mesh, method and degree: the results."""
        return self.table("summary")

    @functools.cached_property
    def thresholds(self):
        """When methods came below the errors that the reference method reaches."""
        return self.table("thresholds")

    @functools.cached_property
    def provenance(self):
        """What the numbers come from: program, machine, meshes, parameters."""
        return json.loads((self.folder / "provenance.json").read_text(encoding="utf-8"))


def _pandas():
    try:
        import pandas
    except ImportError as error:
        raise ImportError("tables of results need pandas; on Debian: apt install python3-pandas") from error
    return pandas


def _program():
    """The compiled program, in the installation or the build folder that this package is in."""
    for folder in Path(__file__).absolute().parents:  # links of the build folder are not followed
        if (program := folder / "libexec" / "smoothfem" / "smoothfem").is_file():
            return program
    raise InputError(f"the program libexec/smoothfem/smoothfem is in no folder above {__file__}; install smoothfem anew")


def _run(words, quiet):
    """Runs the program; an interrupt here is passed on to it, once."""
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
