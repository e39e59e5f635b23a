# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of CSV files, and what a study says about itself in provenance.json."""

import csv
import io
import json
import lzma
from dataclasses import dataclass
from pathlib import Path

import numpy as np


class ResultsError(Exception):
    """A file of the results folder is missing, truncated or malformed; the message is one sentence."""


@dataclass(frozen=True)
class Rows:
    """Rows of a CSV file, column by column, as the strings that stand in the file."""

    path: Path
    columns: dict  # name -> numpy array of str, all of the same length

    def __len__(self):
        return len(next(iter(self.columns.values()), ()))

    def text(self, name):
        """The strings of a column, shape (rows,); empty strings if the file has no such column."""
        return self.columns.get(name, np.full(len(self), "", dtype=object))

    def number(self, name):
        """The numbers of a column, shape (rows,); NaN where the field is empty or not finite."""
        try:
            values = np.array([float(field) if field else np.nan for field in self.text(name)])
        except ValueError as error:
            raise ResultsError(f"{self.path}: column `{name}` holds something that is "
                               f"not a number ({error}).") from None
        return np.where(np.isfinite(values), values, np.nan)

    def require_numbers(self, *names):
        """Raises ResultsError unless each field of the columns is a finite number."""
        for name in names:
            missing = np.flatnonzero(np.isnan(self.number(name)))
            if len(missing):
                field = self.text(name)[missing[0]] or "empty"
                raise ResultsError(f"{self.path}, row {missing[0] + 2}: `{name}` is {field}, not a number; "
                                   "run the study again.")

    def without_number(self, name):
        """Counts the rows in which a column holds a word that is not a number (nan, inf)."""
        return int(np.count_nonzero(np.isnan(self.number(name)) & (self.text(name) != "")))

    def where(self, chosen):
        """The rows with these numbers, or for which a mask is true."""
        return Rows(self.path, {name: column[chosen] for name, column in self.columns.items()})

    def select(self, **wanted):
        """The rows whose columns equal the given strings, in the order of the file."""
        mask = np.ones(len(self), dtype=bool)
        for name, value in wanted.items():
            mask &= self.text(name) == value
        return self.where(mask)

    def records(self):
        """The rows as a list of dictionaries from column name to string."""
        return [dict(zip(self.columns, fields)) for fields in zip(*self.columns.values())]


def packed(path):
    """The path of the xz file that may replace a CSV file."""
    return path.with_name(path.name + ".xz")


def is_there(path):
    """True if a CSV file exists, packed or not."""
    return path.exists() or packed(path).exists()


def open_rows(path):
    """Opens a CSV file for reading, packed or not."""
    if packed(path).exists() and not path.exists():
        return lzma.open(packed(path), "rt", newline="", encoding="utf-8")
    return open(path, newline="", encoding="utf-8")


def read_rows(path, required=(), ends_with_line=True):
    """Reads a CSV file with a header line; raises ResultsError if it is missing, truncated or lacks a
    required column. The program ends every line; files that users write may leave out the last end."""
    path = Path(path)
    try:
        with open_rows(path) as stream:
            text = stream.read()
        lines = list(csv.reader(io.StringIO(text, newline="")))
    except FileNotFoundError:
        raise ResultsError(f"{path}: the file is missing; has the study been run?") from None
    except (EOFError, OSError, UnicodeDecodeError, csv.Error, lzma.LZMAError) as error:
        raise ResultsError(f"{path}: the file cannot be read ({error}).") from None
    if not lines:
        raise ResultsError(f"{path}: the file is empty.")
    if ends_with_line and not text.endswith("\n"):
        raise ResultsError(f"{path}: the last line has no end; the file looks truncated.")
    header, body = lines[0], lines[1:]
    for name in required:
        if name not in header:
            raise ResultsError(f"{path}: column `{name}` is missing.")
    for number, line in enumerate(body, start=2):
        if len(line) != len(header):
            raise ResultsError(f"{path}, row {number}: {len(line)} fields instead of {len(header)}; "
                               "the file looks truncated.")
    # Strings of any length: object arrays, so that comparing and selecting need no common width.
    table = np.array(body, dtype=object).reshape(len(body), len(header))
    return Rows(path, {name: table[:, i] for i, name in enumerate(header)})


SOLVING = ("assembly_seconds", "cg_seconds", "jacobi_cg_seconds", "amg_setup_seconds", "amg_cg_seconds")


def solving_seconds(rows):
    """The cost of a solution, shape (rows,): assembly, where the rows have it, and the fastest solver that was run: CG
    alone, with the diagonal, or with multigrid and its setup. NaN where no time is known."""
    assembly, alone, jacobi, setup, multigrid = map(rows.number, SOLVING)
    return np.nan_to_num(assembly) + np.fmin(np.fmin(alone, jacobi), setup + multigrid)


def solves_itself(rows):
    """True if iterations of a method have solved the problem themselves."""
    return bool((rows.text("n_solves") != "").any())


def groups_of(rows, *names):
    """The rows as (values of these columns, rows that have them), in the order of the file."""
    keys = list(zip(*(rows.text(name) for name in names)))
    found = {}
    for number, key in enumerate(keys):
        found.setdefault(key, []).append(number)
    return [(key, rows.where(numbers)) for key, numbers in found.items()]


def read_provenance(path):
    """Reads provenance.json; an empty dictionary if the file does not exist."""
    try:
        provenance = json.loads(Path(path).read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {}
    except (OSError, ValueError) as error:
        raise ResultsError(f"{path}: not a complete JSON file ({error}).") from None
    if not isinstance(provenance, dict):
        raise ResultsError(f"{path}: a JSON object is expected.")
    return provenance


def is_built_in(provenance):
    """True if the study is identical to a built-in one; only then do statements of the thesis apply to it. Results from
    before this was recorded are judged by their name."""
    return provenance.get("built_in", True) is not False


def entries(provenance, key):
    """The list of named objects under a key of the provenance; bare names count as objects too."""
    found = provenance.get(key)
    if not isinstance(found, list):
        return []
    found = [{"name": entry} if isinstance(entry, str) else entry for entry in found]
    return [entry for entry in found if isinstance(entry, dict) and "name" in entry]


def order_of(names, provenance, key):
    """The names that occur in the rows: first in the order of the provenance, then as they appear."""
    occurring = list(dict.fromkeys(names))
    declared = [entry["name"] for entry in entries(provenance, key) if entry["name"] in occurring]
    return tuple(dict.fromkeys(declared + occurring))
