# SPDX-License-Identifier: GPL-3.0-or-later
"""The solvers of a study that are not Poisson's, and the columns of their numbers."""

from dataclasses import dataclass, field

from .rows import groups_of
from .symbols import of_solver

SECONDS = "_seconds"  # how the names of times end
MOST_SHOWN = 6  # numbers of a solver in one figure
MOST_ERRORS = 4  # of them
ERRORS, ITERATIONS, CONDITION = "error", "iterations", "condition"  # what names of numbers contain


@dataclass(frozen=True)
class Solver:
    """One solver that has given a number."""

    label: str
    title: str
    degrees: tuple  # as in the files; empty: its numbers do not depend on the degree
    columns: tuple  # with numbers, in the order of the file
    described: dict = field(hash=False)  # column -> (unit, meaning)

    @property
    def numbers(self):
        """The columns without times; the times if there is nothing else."""
        return tuple(name for name in self.columns if not name.endswith(SECONDS)) or self.columns


def solvers_of(rows, provenance):
    """The solvers with numbers in these rows, in the order of the provenance. Collections describe no solver there: their labels
    are those of the columns."""
    declared = provenance.get("solvers")
    known = {str(entry["label"]): entry for entry in declared if isinstance(entry, dict) and "label" in entry} if isinstance(declared, list) else {}
    columns = {}
    for name in rows.columns:
        if of_solver(name)[0] and any(rows.text(name)):
            columns.setdefault(of_solver(name)[0], []).append(name)
    return tuple(solver_of(known.get(label), label, tuple(columns[label]), rows)
                 for label in dict.fromkeys((*known, *columns)) if label in columns)


def solver_of(entry, label, columns, rows):
    """One solver; entry: what the provenance says about it, or None."""
    if entry is None:
        return Solver(label, label, degrees_of(rows, columns), columns, {})
    numbers = [number for number in entry.get("numbers", ()) if "column" in number]
    return Solver(label, str(entry.get("title") or label), tuple(map(str, entry.get("degrees") or ())), columns,
                  {number["column"]: (str(number.get("unit") or ""), str(number.get("meaning") or "").rstrip(".")) for number in numbers})


def degrees_of(rows, columns):
    """The degrees with numbers in these columns; none if each mesh has the same numbers at all degrees."""
    # Times differ always.
    columns = [name for name in columns if not name.endswith(SECONDS)] or columns
    of_methods = {}
    for (*method, _), group in groups_of(rows, *(name for name in ("member", "mesh", "method") if name in rows.columns), "degree"):
        of_methods.setdefault(tuple(method), set()).add(tuple(field for name in columns for field in group.text(name)))
    if all(len(records) == 1 for records in of_methods.values()):
        return ()
    with_numbers = {degree for degree, *fields in zip(rows.text("degree"), *map(rows.text, columns)) if any(fields)}
    return tuple(sorted(with_numbers - {""}, key=float))


def main_numbers(columns):
    """The most important columns of a solver: errors, iterations and the condition number first, as many as fit a figure."""
    of_kind = {kind: [name for name in columns if kind in of_solver(name)[1]] for kind in (ERRORS, ITERATIONS, CONDITION)}
    first = [*of_kind[ERRORS][:MOST_ERRORS], *of_kind[ITERATIONS][:1], *of_kind[CONDITION][:1]]
    others = [name for name in columns if not any(name in names for names in of_kind.values())]
    return tuple(dict.fromkeys((*first, *others, *columns)))[:MOST_SHOWN]


def varying(columns, rows):
    """The columns that smoothing changes, unlike the number of degrees of freedom."""
    groups = [group for _, group in groups_of(rows, *(name for name in ("member", "mesh", "degree") if name in rows.columns))]
    return tuple(name for name in columns if any(len({*group.text(name)} - {""}) > 1 for group in groups))
