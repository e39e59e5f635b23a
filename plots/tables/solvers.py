# SPDX-License-Identifier: GPL-3.0-or-later
"""A table for each solver of a study that is not Poisson's: its numbers on initial and resulting meshes."""

from ..results.solvers import SECONDS
from ..results.symbols import of_solver, symbol_of
from .descriptions import KEY_HEADINGS, Measure
from .notes import Notes
from .number_format import format_numbers, format_seconds
from .smoothing import in_study_order, invalid_meshes, key_cells, make_group, without_failures
from .table import Table, heading_of

KEYS = ("mesh", "degree", "method")
TIMES_NOTE = "The times of this solver are in summary.csv."


def make_solver_tables(results):
    """The tables, in the order of the study; none for solvers without numbers."""
    return [solver_table(solver, results) for solver in results.solvers]


def solver_table(solver, results):
    """The table of one solver."""
    rows, sentences = without_failures(results.summary.records(), KEYS, results)
    sentences += invalid_meshes(rows, results)
    # A solver without degrees has the same numbers in the rows of all degrees.
    keys = KEYS if solver.degrees else ("mesh", "method")
    wanted = solver.degrees or results.degrees[:1]
    rows = in_study_order([row for row in rows if not wanted or row.get("degree", "") in wanted], keys, results)
    pairs = [(row, {}) for row in rows]
    groups = [make_group(measure_of(name), pairs, Notes([], pairs), False) for name in solver.numbers]
    cells, rules = key_cells(rows, keys, results)
    return Table(study=results.study, name=f"table_solver_{solver.label}", caption=f"{results.study_title}: {solver.title}", keys=cells,
                 rules=rules, groups=tuple(group for group in groups if group is not None),
                 key_headings=tuple(KEY_HEADINGS[key] for key in keys), left_aligned=(),
                 notes=tuple(("", sentence) for name in solver.numbers if (sentence := sentence_of(name, solver)))
                 + ((("", TIMES_NOTE),) if solver.numbers != solver.columns else ()) + sentences)


def measure_of(column):
    """How a number of a solver is shown: as Poisson's number of the same name."""
    return Measure(column, heading_of(of_solver(column)[1]), format_seconds if column.endswith(SECONDS) else format_numbers)


def sentence_of(column, solver):
    """"h1_error [m]: Error of u in the H1 norm."; empty if the solver says nothing about its number."""
    unit, meaning = solver.described.get(column, ("", ""))
    words = symbol_of(of_solver(column)[1]).text + (f" [{unit}]" if unit else "") + (f": {meaning}" if meaning else "")
    return f"{words}." if unit or meaning else ""
