# SPDX-License-Identifier: GPL-3.0-or-later
"""Gains of solution-adaptive methods over many meshes, seeds and levels of distortion, and their intervals."""

import numpy as np

from ..results.rows import groups_of
from .columns import number, table_of
from .solving_methods import ERRORS
from .table import number_cell, text_cell

KEY = ("solution", "elements", "degree", "method")


def gains_table(results):
    """For each solution, type of elements, degree and method that solves: by which factors true errors are below those on
    the mesh of the first method that does not solve, over all members. Without rows where no method solves."""
    reference = next((method for method in results.methods if method not in results.solving), None)
    rows = results.summary.where(np.isin(results.summary.text("method"), sorted(results.solving)))
    rows = rows.where(rows.text("degree") != "")
    others = {} if reference is None else errors_of(results.summary.select(method=reference))
    groups = sorted(groups_of(rows, *KEY), key=lambda group: (*group[0][:3], results.methods.index(group[0][3])))
    groups = [(key, of_key, factors(of_key, others)) for key, of_key in groups if others]

    def column(which, reduce):
        return [number(reduce(each[which]) if len(each[which]) else np.nan) for _, _, each in groups]
    title = "" if reference is None else results.title(reference)
    return table_of(
        results, "table_energy_gains", "what knowing the solution gains, over all members",
        [("Solution", [text_cell(key[0]) for key, _, _ in groups]),
         ("Elements", [text_cell(key[1]) for key, _, _ in groups]),
         ("d", [number_cell(key[2]) for key, _, _ in groups]),
         ("Method", [text_cell(results.title(key[3])) for key, _, _ in groups])],
        [("Members", [("", [number_cell(str(len(of_key))) for _, of_key, _ in groups])]),
         *((name, [(heading, column(which, reduce)) for heading, reduce in
                   (("least", np.min), ("median", np.median), ("largest", np.max))])
           for which, (name, _) in enumerate(ERRORS)),
         ("q_min", [("least", [number(np.nanmin(of_key.number("q_min")), ".3f") for _, of_key, _ in groups])]),
         ("With invalid cells", [("", [number_cell(str(int((of_key.number("n_invalid") > 0).sum())))
                                       for _, of_key, _ in groups])])],
        [f"Factors: true errors on the mesh of {title} over those on the method's; below 1 the error has risen. Members are "
         "meshes of all domains, sizes, levels of distortion and seeds."])


def errors_of(rows):
    """(member, degree) -> H1 and L2 error."""
    return dict(zip(zip(rows.text("member"), rows.text("degree")), zip(*(rows.number(column) for _, column in ERRORS))))


def factors(rows, others):
    """Returns an array for each error: over all members where both are known."""
    own_errors = errors_of(rows)
    both = [(others.get(key, (np.nan,) * len(ERRORS)), errors) for key, errors in own_errors.items()]
    found = [np.array([other[which] / own[which] for other, own in both if own[which] > 0]) for which in range(len(ERRORS))]
    return [values[np.isfinite(values)] for values in found]
