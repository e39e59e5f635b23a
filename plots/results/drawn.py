# SPDX-License-Identifier: GPL-3.0-or-later
"""Remembers what the figures in a folder were made of, so that only changed figures are drawn again."""

import hashlib
import json
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from .write_files import write_atomically

FILE = ".drawn.json"
PACKAGE = Path(__file__).resolve().parents[1]
# What no figure shows.
NOT_SHOWN = ("study_title", "note", "status", "written", "sessions", "seconds", "results", "kept", "program", "machine", "settings",
             "parameters")


def digest_of_files(paths):
    """One digest of the names and contents of files."""
    digest = hashlib.sha256()
    for path in sorted(paths):
        digest.update(f"{path.name} {path.stat().st_size}\n".encode())
        with open(path, "rb") as file:
            while block := file.read(1 << 20):
                digest.update(block)
    return digest.hexdigest()


def inputs_of(folder, provenance, more):
    """A digest of everything that the figures of a results folder are made of: its rows and meshes, titles, the program that
    draws, and `more`, for example the width."""
    folder = Path(folder)
    shown = {key: value for key, value in provenance.items() if key not in NOT_SHOWN}
    data = [path for pattern in ("*.csv", "*.csv.xz", "meshes/*.vtu") for path in folder.glob(pattern)]
    code = digest_of_files(PACKAGE.rglob("*.py"))
    text = json.dumps([shown, digest_of_files(data), code, version_of_matplotlib(), more], sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()


def version_of_matplotlib():
    """The version; empty without matplotlib."""
    try:
        return version("matplotlib")
    except PackageNotFoundError:
        return ""


class Drawn:
    """The figures of a results folder, by name: the digest of what they were made of, and their files."""

    def __init__(self, folder, inputs):
        self.list, self.folder, self.inputs = Path(folder) / FILE, Path(folder) / "figures", inputs
        try:
            known = json.loads(self.list.read_text(encoding="utf-8"))
            self.figures = {str(name): (str(inputs), [str(file) for file in files]) for name, (inputs, files) in known["figures"].items()}
            self.whole = str(known["whole"])
        except (OSError, ValueError, KeyError, TypeError, AttributeError):  # nothing is known, so all are drawn
            self.figures, self.whole = {}, ""

    def paths(self, name):
        """The files of a figure that is up to date; None if it has to be drawn."""
        inputs, files = self.figures.get(name, ("", []))
        paths = [self.folder / file for file in files]
        return paths if inputs == self.inputs and all(path.is_file() for path in paths) else None

    def all_paths(self):
        """The files of all figures, if all are up to date; otherwise None."""
        found = [self.paths(name) for name in self.figures]
        if self.whole != self.inputs or any(paths is None for paths in found):
            return None
        return [path for paths in found for path in paths]

    def note(self, name, paths):
        """Remembers a figure that has been drawn; no paths: it has nothing to show."""
        self.figures[name] = (self.inputs, [path.name for path in paths])

    def save(self, all_names=None):
        """Writes the list. all_names: of all figures that there are; files of others are removed."""
        if all_names is not None:
            for name in set(self.figures) - set(all_names):
                for file in self.figures.pop(name)[1]:
                    (self.folder / Path(file).name).unlink(missing_ok=True)
            self.whole = self.inputs
        write_atomically(self.list, json.dumps({"whole": self.whole, "figures": self.figures}, indent=1))
