# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of a polygon study: the theorems of Chapter 2, and classification against iteration."""

import numpy as np

from ..results.rows import groups_of
from ..results.symbols import Heading
from .number_format import format_scientific
from .table import Group, Table, escape_tex, number_cell, text_cell


def make_polygon_tables(results):
    """Both tables, for formats.py."""
    return [theorem_table(results), classification_table(results)]


def column(heading, cells):
    """A group of one column."""
    return Group(Heading(heading, escape_tex(heading)), ("",), tuple((cell,) for cell in cells))


def theorem_table(results):
    """A row for each statement: the worst case of what was measured, and whether it holds."""
    rows = results.theorems
    names = list(rows.text("theorem"))
    numbers = {name: [number_cell(text) for text in format_scientific(rows.number(name))]
               for name in ("max_deviation", "tolerance")}
    values = {name: [number_cell(f"{value:.6g}") for value in rows.number(name)]
              for name in ("measured", "expected")}
    verdicts = [text_cell("yes" if text == "true" else "NO") for text in rows.text("holds")]
    return Table(
        study=results.study, name="table_theorems",
        caption=f"{results.study_title}: the theorems of Chapter 2, measured",
        key_headings=(Heading("Theorem", "Theorem"),),
        keys=tuple((text_cell("" if i and names[i - 1] == name else name),)
                   for i, name in enumerate(names)),
        rules=(), left_aligned=("Statement", "Quantity", "Holds"),
        groups=(column("Statement", [text_cell(text) for text in rows.text("statement")]),
                column("Quantity", [text_cell(text) for text in rows.text("quantity")]),
                column("Cases", [number_cell(text) for text in rows.text("cases")]),
                column("Measured", values["measured"]), column("Expected", values["expected"]),
                column("Deviation", numbers["max_deviation"]),
                column("Tolerance", numbers["tolerance"]), column("Holds", verdicts)),
        notes=(("", "Numbers of the worst of all cases, each with random nodes and angles. If the quantity has to "
                    "stay above or below the expected number, the deviation is the amount of the violation."),
               ("", "t = tan(theta). The factor of Proposition 2.2 for theta > pi/6 is that of its proof, "
                    "1 / (1 + min(1, z/x)^2), which depends on the triangle.")))


def classification_table(results):
    """A row for each number of nodes: how many pairs of parameters, how many disagreements."""
    counted = []
    for (n,), rows in groups_of(results.classification, "n"):
        on_lines = np.char.startswith(rows.text("predicted").astype(str), "S")
        disagree = rows.text("agree") != "true"
        counted.append((n, np.count_nonzero(~on_lines), np.count_nonzero(on_lines),
                        np.count_nonzero(disagree)))
    keys, *numbers = zip(*counted)
    headings = ("Pairs inside the domains", "Pairs on the lines", "Disagreements")
    return Table(
        study=results.study, name="table_classification",
        caption=f"{results.study_title}: limits predicted, against those found by iteration",
        key_headings=(Heading("n", "$n$"),), keys=tuple((number_cell(n),) for n in keys), rules=(),
        left_aligned=(),
        groups=tuple(column(heading, [number_cell(str(value)) for value in values])
                     for heading, values in zip(headings, numbers)),
        notes=(("", "Pairs (theta, lambda): a grid, and for each of its angles the points where two dominant "
                    "eigenvalues are equal. Predicted by the dominant eigenvalue, found by iterating "
                    "a random polygon."),))
