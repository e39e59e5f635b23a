# SPDX-License-Identifier: GPL-3.0-or-later
"""A table for each solver of a study that is not Poisson's: its numbers on initial and resulting meshes."""

from ..results.symbols import Heading, symbol_of
from .descriptions import KEY_HEADINGS, Measure
from .notes import Notes
from .number_format import format_numbers, format_seconds
from .smoothing import in_study_order, invalid_meshes, key_cells, make_group, without_failures
from .table import Table, escape_tex

KEYS = ("mesh", "degree", "method")
TIMES_NOTE = "The times of this solver are in summary.csv."


def make_solver_tables(results):
    """The tables, in the order of the study; none for solvers without numbers."""
    solvers = results.provenance.get("solvers")
    tables = [solver_table(solver, results) for solver in solvers] if isinstance(solvers, list) else []
    return [table for table in tables if table is not None]


def solver_table(solver, results):
    """The table of one solver, as provenance.json describes it; None if it has no numbers."""
    start = f"{solver['label']}."
    columns = [name for name in results.summary.columns if name.startswith(start) and any(results.summary.text(name))]
    times = [name for name in columns if name.endswith("_seconds")]
    columns = [name for name in columns if name not in times] or columns
    if not columns:
        return None
    rows, sentences = without_failures(results.summary.records(), KEYS, results)
    sentences += invalid_meshes(rows, results)
    # A solver without degrees has the same numbers in the rows of all degrees.
    keys = KEYS if solver.get("degrees") else ("mesh", "method")
    wanted = [str(degree) for degree in solver.get("degrees") or results.degrees[:1]]
    rows = in_study_order([row for row in rows if not wanted or row.get("degree", "") in wanted], keys, results)
    pairs = [(row, {}) for row in rows]
    groups = [make_group(measure_of(name, start), pairs, Notes([], pairs), False) for name in columns]
    cells, rules = key_cells(rows, keys, results)
    described = {number["column"]: number for number in solver.get("numbers", [])}
    return Table(study=results.study, name=f"table_solver_{solver['label']}",
                 caption=f"{results.study_title}: {solver.get('title', solver['label'])}", keys=cells, rules=rules,
                 groups=tuple(group for group in groups if group is not None),
                 key_headings=tuple(KEY_HEADINGS[key] for key in keys), left_aligned=(),
                 notes=tuple(("", sentence_of(name, described[name], start)) for name in columns if name in described)
                 + ((("", TIMES_NOTE),) if times else ()) + sentences)


def measure_of(column, start):
    """How a number of a solver is shown: as Poisson's number of the same name."""
    name = column[len(start):]
    heading = symbol_of(name)
    return Measure(column, Heading(heading.text, escape_tex(name)) if heading.text == name else heading,
                   format_seconds if name.endswith("_seconds") else format_numbers)


def sentence_of(column, number, start):
    """"h1_error: Error of u in the H1 norm [m]"; the heading alone if the solver says nothing about its number."""
    unit = f" [{number['unit']}]" if number.get("unit") else ""
    meaning = str(number.get("meaning", "")).rstrip(".")
    return f"{symbol_of(column[len(start):]).text}{unit}{': ' if meaning else ''}{meaning}."
