# SPDX-License-Identifier: GPL-3.0-or-later
"""One table of the columns of summary.csv that a user chooses."""

from ..results.names import find_column
from ..results.rows import ResultsError
from ..results.smoothing import number_columns
from .descriptions import KEY_HEADINGS, TABLES, Measure
from .number_format import format_numbers
from .smoothing import in_study_order, invalid_meshes, key_cells, make_group, meanings, without_failures
from .notes import Notes
from .table import Group, Table, heading_of, text_cell

CHOSEN = "table_chosen"  # its file name without suffix
KEYS = ("mesh", "degree", "method")
DESCRIBED = {measure.column: measure for table in TABLES for measure in table.measures if table.source == "summary"}


def chosen_table(results, wanted):
    """The table of the wanted columns, by their names or headings; mesh, degree and method stand first. Raises ResultsError
    for an unknown column, or if rows cannot be told apart."""
    columns = [find_column(name, list(results.summary.columns), list(results.summary.columns)) for name in wanted]
    columns = list(dict.fromkeys(columns))
    keys = tuple(key for key in KEYS if key in columns)
    rows, sentences = without_failures(results.summary.records(), KEYS, results)
    rows = in_study_order(rows, KEYS, results)
    sentences += invalid_meshes(rows, results)
    rows = list({tuple(row.get(name, "") for name in columns): row for row in reversed(rows)}.values())[::-1]
    refuse_unclear(rows, keys, results)
    numbers = number_columns(results.summary)
    measures = [DESCRIBED.get(name) or plain_measure(name, numbers) for name in columns if name not in keys]
    groups = {measure: make_column(measure, rows) for measure in measures}
    cells, rules = key_cells(rows, keys, results) if keys else (((),) * len(rows), ())
    return Table(study=results.study, name=CHOSEN, caption=results.study_title, keys=cells, rules=rules,
                 groups=tuple(groups.values()), key_headings=tuple(KEY_HEADINGS[key] for key in keys),
                 left_aligned=tuple(measure.heading.text for measure in measures if measure.format is None),
                 notes=meanings(keys, groups, rows) + sentences)


def plain_measure(column, numbers):
    """How a column is shown that no other table has; numbers: the columns that hold numbers."""
    return Measure(column, heading_of(column), format_numbers if column in numbers or column.endswith("_seconds") else None)


def make_column(measure, rows):
    """The column of a measure, without numbers of the thesis."""
    fields = [row.get(measure.column, "") for row in rows]
    if not any(fields):
        return Group(measure.heading, ("",), tuple((text_cell("–"),) for _ in rows))
    pairs = [(row, {}) for row in rows]
    return make_group(measure, pairs, Notes([], pairs), False) or Group(
        measure.heading, ("",), tuple((text_cell(text),) for text in measure.numbers(fields)[1]))


def refuse_unclear(rows, keys, results):
    """Raises ResultsError if rows differ in a key that is no column."""
    for key, names, option in (("mesh", results.meshes, "--meshes"), ("degree", results.degrees, "--degrees"),
                               ("method", results.methods, "--methods")):
        others = [name for name in KEYS if name != key]
        found = {}
        for row in rows:
            found.setdefault(tuple(row.get(name, "") for name in others), set()).add(row.get(key, ""))
        if key not in keys and any(len(values) > 1 for values in found.values()):
            raise ResultsError(f"{results.folder}: rows of the table differ by {key}; add {key} to --columns, or choose one of "
                               f"{', '.join(names)} by {option}.")
