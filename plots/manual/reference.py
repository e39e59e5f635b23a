# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of reference results for the pages: rows of studies, means and their texts."""

from functools import lru_cache

import numpy as np

from ..results.collection import ends
from ..results.rows import read_rows

METHOD, REFERENCE_METHOD = "getme-simultaneous", "GETMe simultaneous"  # name and title of the first method of the studies
SOLVER = "jacobi_cg_iterations"
PERCENT = 100


@lru_cache(maxsize=None)
def tables_of(reference, study, name):
    """The rows of a table of a collection."""
    return read_rows(reference / study / "tables" / f"{name}.csv").records()


def pairs_of(reference, study):
    """(initial meshes, results of the reference method) of a collection, aligned by member and degree."""
    rows = read_rows(reference / study / "summary.csv")
    both = ends(rows.where(rows.text("degree") != "")).select(method=METHOD)
    return both.where(slice(0, None, 2)), both.where(slice(1, None, 2))


def of_study(reference, study):
    """(mesh, degree, method) -> record of a summary."""
    return {(row["mesh"], row["degree"], row["method"]): row
            for row in read_rows(reference / study / "summary.csv").records()}


def factor(rows, mesh, degree, column, over="getme", under="initial"):
    """The number of one method's mesh over that of another."""
    return float(rows[mesh, degree, under][column]) / float(rows[mesh, degree, over][column])


def interval(text):
    """"0.95 to 1.02" of a table as "0.95 to 1.02" with two digits."""
    return " to ".join(f"{float(end):.2f}" for end in text.split(" to "))


def with_interval(row, column):
    """"0.98 (0.95 to 1.02)"."""
    return f"{float(row[column]):.2f} ({interval(row[column + ' interval'])})" if row[column + " interval"] else f"{float(row[column]):.2f}"


def spread(numbers, form=".2f"):
    """"0.95 to 1.02"; one number if both are equal."""
    ends_of_range = dict.fromkeys(f"{number:{form}}" for number in (min(numbers), max(numbers)))
    return " to ".join(ends_of_range)


def geometric_mean(ratios):
    """The geometric mean of the known ratios."""
    return float(np.exp(np.nanmean(np.log(ratios))))


def mean_ratio(ratios):
    """The geometric mean of the known ratios, as a text."""
    return f"{geometric_mean(ratios):.2f}"
