# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs studies by the program, so that their results do not depend on Python, and reads the results as tables of pandas."""

import functools
import json
import operator
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

from ._arguments import shown, text, wrong
from ._core import InputError

PREFIX = "smoothfem: "  # of the program's messages
MARK = "# Written by smoothfem.Study; a run replaces it."  # first line of files that were dicts


class Study:
    """A study, given by its file, by the name of a built-in study, or by a dict with the keys of a study file.

    In a dict, keys are as in files, a subsection is a dict ({"solution": {"u": "sin(x)*y"}}), and a list stands for values with commas. run()
    writes it as the file NAME.prm in the current folder, where relative names of files in it belong, and so do the messages of the program.
    """

    def __init__(self, file, scale=None, *, name="study"):
        self.scale, self.text = None if scale is None else text("scale", scale), None
        if hasattr(file, "items"):
            if not re.fullmatch(r"[A-Za-z0-9][\w.-]*", text("name", name), re.ASCII):
                raise wrong("name", name, "of letters, digits, '.', '_' and '-'")
            self.text = "\n".join([MARK, *_lines(file)]) + "\n"
            file = f"{name}.prm"
        try:
            self.file = os.fspath(file)
        except TypeError:
            raise wrong("the study", file, "a file, the name of a built-in study, or a dict of keys") from None

    def __repr__(self):
        return f"<smoothfem.Study: {self.file}{'' if self.scale is None else f', scale {self.scale}'}>"

    @property
    def name(self):
        """Returns the file's name without its suffix."""
        return Path(self.file).name.removesuffix(".prm")

    def write(self):
        """Writes a study that is a dict as its file; does nothing for others. A file that is not from here is not replaced."""
        if self.text is None:
            return
        path = Path(self.file)
        if path.exists() and not path.read_text(encoding="utf-8", errors="replace").startswith(MARK):
            raise InputError(f"{path} exists and was not written by smoothfem.Study; give the study another name=")
        unfinished = path.with_name(f".{path.name}.part")
        unfinished.write_text(self.text, encoding="utf-8")
        unfinished.replace(path)

    def run(self, out=None, *, force=False, mesh_dir=None, threads=None, smoothing_threads=None, quiet=True):
        """Runs the study in a separate process, and returns its Results.

        out: folder of the results (default: results/NAME). A complete study in it is not changed; an interrupted study
        resumes. force: start again; the folder is renamed and kept. mesh_dir: folder of published meshes. threads,
        smoothing_threads: the options of the program. quiet: if False, progress is printed to standard error. Raises
        InputError with the program's message if an input cannot be used. After Ctrl-C the program writes the rows
        that are complete.
        """
        self.write()
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


def _lines(keys, subsection=""):
    """Returns the lines of a study file for a dict of keys."""
    lines = []
    for key, value in keys.items():
        place = f"{subsection}{key if isinstance(key, str) else shown(key)}"
        if not isinstance(key, str) or not key.strip() or any(c in key for c in "\n#"):
            raise InputError(f"the study's key {shown(key)} is not a key of a study file")
        if hasattr(value, "items"):
            lines += [f"subsection {key}", *(f"  {line}" for line in _lines(value, f"{place} / ")), "end"]
        elif value is not None:
            lines.append(f"set {key} = {_value(place, value)}")
    return lines


def _value(place, value):
    """Returns a value of a dict as the text of a study file."""
    if hasattr(value, "__fspath__"):
        value = os.fspath(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        if "\n" in value or "#" in value:
            raise InputError(f"the value of the study's key '{place}' has a line break or #, which study files cannot hold")
        return value
    if hasattr(value, "__iter__") and not hasattr(value, "items") and not isinstance(value, (bytes, bytearray)):
        return ", ".join(_value(place, entry) for entry in value)
    try:
        return str(operator.index(value))
    except TypeError:
        pass
    try:
        if isinstance(value, (bytes, bytearray)):  # float() would read them
            raise TypeError
        return repr(float(value))
    except (TypeError, ValueError):
        raise wrong(f"the value of the study's key '{place}'", value, "a text, a number, True, False, a path or a list of these; only a "
                    "subsection is a dict") from None


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
