# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the printed tables that a study is compared with, and known reasons of deviations.

The values stand in studies/thesis/; its README.md says where each of them is printed.
"""

from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path

from .data_folder import THESIS, thesis_folder
from .rows import ResultsError, entries, read_rows


@dataclass
class PrintedTable:
    """The printed values of one kind of content (`smoothing`, `solver`, `errors`, `thresholds`)."""

    number: str = ""
    measured_on: str = ""
    rows: list = field(default_factory=list)  # dictionaries from column name to string
    # table, mesh, degree, method, column, known_from, note; if known_from is empty, the note says so.
    deviations: list = field(default_factory=list)


def read_printed_tables(study, provenance):
    """The printed tables of a study as a dictionary from content to PrintedTable; `study` as in
    Results.thesis_study.

    The provenance may choose them (`printed_values`: table numbers or paths); without that key the
    tables are those listed for a study of this name. Empty if there is nothing to compare with.
    """
    folder = thesis_folder()
    index = folder / "tables.csv"
    if not index.exists():
        return {}
    chosen = provenance.get("printed_values")
    tables = {}
    for entry in read_rows(index, ("table", "study", "content", "file", "measured_on")).records():
        if is_chosen(entry, study, chosen):
            table = tables.setdefault(entry["content"],
                                      PrintedTable(entry["table"], entry["measured_on"]))
            table.rows += read_rows(folder / entry["file"], ("mesh", "method")).records()
    deviations = folder / "deviations.csv"
    if tables and deviations.exists():
        required = ("table", "mesh", "degree", "method", "column", "known_from", "note")
        notes = [{**row, "note": row["note"] if row["known_from"] else as_guess(row["note"])}
                 for row in read_rows(deviations, required).records()]
        for table in tables.values():
            table.deviations = [note for note in notes if fnmatchcase(table.number, note["table"])]
    return tables


def as_guess(reason):
    """A reason for a deviation that nothing is known from."""
    return f"Guess, tested by no run: {reason}"


def is_chosen(entry, study, chosen):
    """True if an entry of the index belongs to a study that names the `chosen` tables or paths."""
    if chosen is None:
        return entry["study"] == study
    if not isinstance(chosen, list):
        raise ResultsError("provenance.json: `printed_values` is not a list.")
    names = {Path(str(name)).stem for name in chosen if "/" in str(name) or str(name).endswith(".csv")}
    numbers = {str(name).removeprefix("table_").replace("_", ".") for name in chosen}
    # A folder stands for all of its tables that belong to the study.
    return (Path(entry["file"]).stem in names or entry["table"] in numbers
            or (THESIS.name in names and entry["study"] == study))


def comparison_notes(table, results):
    """Notes on the meshes of the printed values, whether the study used these meshes, and the study's own remark: a
    list."""
    measured = [row["mesh"] for row in table.rows]
    stand_ins = [mesh for mesh in results.meshes if mesh in measured and not results.is_published(mesh)]
    note = f"Values of the thesis: Table {table.number}, measured on the {table.measured_on}."
    own = [results.note] if results.note else []
    if not stand_ins:
        return [note, *own]
    known = {entry["name"] for entry in entries(results.provenance, "meshes") if "published" in entry}
    names = ", ".join(stand_ins)
    if not known.issuperset(stand_ins):
        return [f"{note} The results do not record whether these meshes were used for: {names}.", *own]
    return [f"{note} Not these meshes but stand-ins for them, whose numbers cannot be compared digit "
            f"for digit: {names}.", *own]
