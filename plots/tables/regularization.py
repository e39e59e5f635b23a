# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of a regularization study: printed numbers of Chapter 3 next to computed ones."""

import numpy as np

from ..results.data_folder import thesis_folder
from ..results.regularization import whole
from ..results.rows import groups_of, read_rows
from ..results.symbols import Heading
from .number_format import MISSING, relative_difference
from .table import Group, Table, number_cell


def least_mean(rows):
    """(sigma, mean) where the mean number of transformations is least; NaN where no sigma is whole."""
    rows = whole(rows)
    if not len(rows):
        return float("nan"), float("nan")
    best = int(np.argmin(rows.number("mean")))
    return rows.number("sigma")[best], rows.number("mean")[best]


def printed_numbers():
    """(quantity, element, transformation, start) -> the number as printed."""
    rows = read_rows(thesis_folder() / "chapter_3.csv",
                     ("quantity", "element", "transformation", "start", "printed")).records()
    return {(r["quantity"], r["element"], r["transformation"], r["start"]): r["printed"] for r in rows}


def compared(heading, texts, printed):
    """Returns a group of computed numbers, printed numbers and their difference; only computed numbers if none are printed."""
    if not any(printed):
        return Group(Heading(heading, heading), ("",), tuple((number_cell(t),) for t in texts))
    return Group(Heading(heading, heading), ("smoothfem", "thesis", "%"), tuple(
        (number_cell(computed), number_cell(theirs or MISSING),
         number_cell(relative_difference(float(computed), theirs or "")))
        for computed, theirs in zip(texts, printed)))


def make_regularization_tables(results):
    """The fastest sigma of each series, and the fractions of valid elements."""
    printed = printed_numbers() if results.is_thesis_study else {}
    series = groups_of(results.counts, "element", "transformation", "start")
    least = [least_mean(rows) for _, rows in series]
    at_two = [rows.number("mean")[-1] for _, rows in series]
    fastest = Table(
        study=results.study, name="table_fastest",
        caption=f"{results.study_title}: sigma with the fewest transformations",
        key_headings=tuple(Heading(n, n) for n in ("Element", "Transformation", "Start")),
        keys=tuple(tuple(number_cell(text) for text in key) for key, _ in series), rules=(),
        left_aligned=(),
        groups=(compared("Sigma", [f"{sigma:.2f}" for sigma, _ in least],
                         [printed.get(("sigma", *key)) for key, _ in series]),
                compared("Mean number", [f"{mean:.2f}" for _, mean in least],
                         [printed.get(("mean", *key)) for key, _ in series]),
                compared("Mean number at the largest sigma", [f"{mean:.2f}" for mean in at_two],
                         [None] * len(series))),
        notes=(("", "Transformations until the mean ratio is at least 1 - tolerance; least mean over the "
                    "sigmas that made every element regular." + (
                        " The thesis does not say what its printed number started from; it is the one "
                        "for valid elements." if printed else "")),))
    elements = list(results.validity.text("element"))
    valid = Table(
        study=results.study, name="table_valid",
        caption=f"{results.study_title}: valid ones among random elements (%)",
        key_headings=(Heading("Element", "Element"),),
        keys=tuple((number_cell(element),) for element in elements), rules=(), left_aligned=(),
        groups=(compared("Valid", [f"{100 * fraction:.2f}" for fraction in results.validity.number("share")],
                         [printed.get(("valid", element, "", "")) for element in elements]),),
        notes=(("", "Nodes uniform in [-1, 1]^3. Both are random samples: with 100,000 elements the share "
                    "of 50 % has a standard deviation of 0.16."),))
    return [fastest, valid]
