# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a study that was run again has the numbers of its reference: every column of its CSV files to the last
digit but for times and memory, which are the machine's. What was found is kept in results/reference/again.csv."""

import csv
import io
import lzma
from datetime import date
from itertools import zip_longest

FILE = "again.csv"
COLUMNS = ("study", "commit", "again", "written", "rows", "different")
TABLES = ("iterations.csv", "summary.csv", "refined.csv", "solutions.csv", "thresholds.csv", "members.csv", "metrics.csv")
OF_THE_MACHINE = ("seconds", "_gib", "speedup")  # how the names of such columns end


def is_compared(column):
    """Whether a column's numbers should be the same on every machine."""
    return not column.endswith(OF_THE_MACHINE)


def rows_of(folder, name):
    """The rows of a table of a results folder, which may be packed; None if it has no such table."""
    path, packed = folder / name, folder / f"{name}.xz"
    if not path.exists() and not packed.exists():
        return None
    data = path.read_bytes() if path.exists() else lzma.decompress(packed.read_bytes())
    return list(csv.DictReader(io.StringIO(data.decode("utf-8"))))


def differences(reference, results):
    """Of two folders of a study: the number of the reference's rows, and what differs, a line for each row. Columns that
    only one of them has are of another version of the program, and are not looked at."""
    n_rows, found = 0, []
    for name in TABLES:
        old, new = rows_of(reference, name), rows_of(results, name)
        if old is None:
            continue
        n_rows += len(old)
        for i, (before, after) in enumerate(zip_longest(old, new or [])):
            if before is None or after is None:
                found.append(f"{name}, row {i + 1}: only in the {'results' if before is None else 'reference'}")
                continue
            columns = [column for column in before
                       if is_compared(column) and column in after and before[column] != after[column]]
            if columns:
                found.append(f"{name}, row {i + 1}: " + ", ".join(
                    f"{column} {before[column]} in the reference, now {after[column]}" for column in columns))
    return n_rows, found


def read_records(reference):
    """What is kept of studies that were run again: study -> row."""
    path = reference / FILE
    if not path.exists():
        return {}
    with path.open(encoding="utf-8", newline="") as lines:
        return {row["study"]: row for row in csv.DictReader(lines)}


def keep_record(reference, study, commit, again, n_rows, n_different):
    """Keeps what was found of a study: its reference is of `commit`, it was run again at the commit `again`."""
    records = read_records(reference)
    row = (study, commit, again, date.today().isoformat(), n_rows, n_different)
    records[study] = dict(zip(COLUMNS, map(str, row)))
    write_records(reference, records)


def drop_record(reference, study):
    """Forgets a study, whose reference is a new one."""
    records = read_records(reference)
    if records.pop(study, None):
        write_records(reference, records)


def write_records(reference, records):
    """Writes the file in one piece."""
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(records[study] for study in sorted(records))
    new = reference / f".{FILE}.new"
    new.write_text(text.getvalue(), encoding="utf-8")
    new.replace(reference / FILE)
