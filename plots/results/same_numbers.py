# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares a study that was run again with its reference: every column of its CSV files to the last digit, except times
and memory, which depend on the machine. Results of comparisons are kept in results/reference/again.csv. It also holds
the references that need not be run again, as a program with the same sources made them."""

import csv
import io
from datetime import date
from itertools import zip_longest

from .rows import is_there, open_rows, read_rows
from .write_files import write_atomically

FILE = "again.csv"
COLUMNS = ("study", "commit", "again", "written", "rows", "different")
TABLES = ("iterations.csv", "summary.csv", "refined.csv", "solutions.csv", "thresholds.csv", "members.csv", "metrics.csv")
OF_THE_MACHINE = ("seconds", "_gib", "speedup")  # how the names of such columns end


def table_of(path):
    """The rows of a CSV file, packed or not; an empty list if the file does not exist."""
    if not is_there(path):
        return []
    with open_rows(path) as lines:
        return list(csv.DictReader(lines))


def changed(before, after):
    """The columns that differ in two rows. Columns that depend on the machine do not count, nor columns of only one
    row, which come from another version of the program."""
    return [name for name in before
            if not name.endswith(OF_THE_MACHINE) and name in after and before[name] != after[name]]


def differences(reference, results):
    """Compares two folders of a study; returns the number of the reference's rows, and the differences, a line for each
    row. Tables that only the results have come from another version, too."""
    n_rows, found = 0, []
    for table in TABLES:
        old = table_of(reference / table)
        new = table_of(results / table) if is_there(reference / table) else []
        n_rows += len(old)
        for number, (before, after) in enumerate(zip_longest(old, new), start=1):
            if before is None or after is None:
                found.append(f"{table}, row {number}: only in the {'results' if before is None else 'reference'}")
            elif names := changed(before, after):
                found.append(f"{table}, row {number}: " + ", ".join(
                    f"{name} {before[name]} in the reference, now {after[name]}" for name in names))
    return n_rows, found


def read_records(reference):
    """Reads the records of studies that were run again: study -> row of again.csv."""
    path = reference / FILE
    return {row["study"]: row for row in read_rows(path, COLUMNS).records()} if path.exists() else {}


def is_of(record, provenance):
    """True if a study's record belongs to the current reference."""
    return record.get("commit") == provenance.get("program", {}).get("commit", "")


def keep_record(reference, study, commit, again, n_rows, n_different):
    """Keeps what was found of a study: its reference is of `commit`, it was run again at the commit `again`."""
    row = (study, commit, again, date.today().isoformat(), n_rows, n_different)
    write_records(reference, {**read_records(reference), study: dict(zip(COLUMNS, row))})


def keep_same_program(reference, study, commit, again):
    """Keeps that the program of a study's reference, of `commit`, is that of the commit `again`: no row was compared."""
    keep_record(reference, study, commit, again, "", 0)


def drop_record(reference, study):
    """Forgets a study, whose reference is a new one."""
    records = read_records(reference)
    if records.pop(study, None):
        write_records(reference, records)


def write_records(reference, records):
    """Writes the file, by the names of the studies."""
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(records[study] for study in sorted(records))
    write_atomically(reference / FILE, text.getvalue())
