# SPDX-License-Identifier: GPL-3.0-or-later
"""Orders of the errors in the mesh size h, where a collection has the same mesh in three or more sizes.

h is the number of cells to the power of minus one over the dimension: smoothing does not change it."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..results.smoothing import INITIAL
from ..statistics.lines import FEWEST_POINTS, slope
from .problems import AS_GENERATED, level_number

ERRORS = {"h1_error": "H1", "l2_error": "L2"}
LEAST_CHANGE = 0.1  # of an order; below it counts as a change of the constant


@dataclass(frozen=True)
class Order:
    """The order of an error on the meshes that a method makes of one mesh in several sizes."""

    elements: str
    degree: str
    level: str
    family: str
    algorithm: str
    solution: str
    method: str  # `initial`: before smoothing
    error: str
    order: float  # NaN: fewer than three sizes have a result
    interval: tuple
    change: float  # of the order by smoothing; NaN for the initial mesh
    change_interval: tuple
    n_sizes: int  # that have a result

    @property
    def mesh(self):
        """What the order belongs to, apart from method and error."""
        return self.elements, self.degree, self.level, self.family, self.algorithm, self.solution


def errors_of(solver):
    """The columns of the errors of a solver; None is Poisson's."""
    return tuple(ERRORS) if solver is None else tuple(name for name in solver.columns if name.endswith("_error"))


@lru_cache(maxsize=8)
def orders(results, solver=None):
    """The orders of all errors of a solver, sorted by type of elements, degree, level, family and method; the initial mesh comes first.
    solver: None is Poisson's."""
    found, errors = [], [name for name in errors_of(solver) if np.isfinite(results.summary.number(name)).any()]
    for mesh, sizes in sorted(meshes_in_sizes(results, solver, errors).items(), key=lambda entry: (
            *entry[0][:2], entry[0][2] != AS_GENERATED, -level_number(entry[0][2]), entry[0][3:])):
        for method in (INITIAL, *results.methods):
            found += [order_of(mesh, method, error, sizes) for error in errors]
    return found


def meshes_in_sizes(results, solver, errors):
    """What an order belongs to -> {size: [{(method, error): logarithm, "h": logarithm} of each seed]}, with three or more sizes."""
    rows = results.summary
    if solver and not solver.degrees and len(rows):  # all degrees have the same numbers
        rows = rows.select(degree=min(rows.text("degree")))
    members = {row["member"]: row for row in results.members.records()}
    records = {}
    values = {error: rows.number(error) for error in errors}
    invalid = rows.number("n_invalid")
    for k, (name, degree, method) in enumerate(zip(*(rows.text(column) for column in ("member", "degree", "method")))):
        member = members.get(name)
        if (degree or solver) and member and member.get("size") and member.get("n_cells"):
            record = records.setdefault((name, degree), {"h": -np.log(float(member["n_cells"])) / float(member["dimension"])})
            for error in errors:
                if invalid[k] == 0 and values[error][k] > 0:
                    record[method, error] = np.log(values[error][k])
    found = {}
    for (name, degree), record in records.items():
        member = members[name]
        mesh = (member["elements"], degree, member.get("distortion") or AS_GENERATED, member["family"], member.get("algorithm", ""),
                member["solution"])
        found.setdefault(mesh, {}).setdefault(float(member["size"]), []).append(record)
    return {mesh: sizes for mesh, sizes in found.items() if len(sizes) >= FEWEST_POINTS}


def order_of(mesh, method, error, sizes):
    """The order of one error on the meshes of one method. Seeds of a size give one mean."""
    after, change = (slope(*points) for points in (means(sizes, lambda record: record.get((method, error))),
                                                   means(sizes, lambda record: ratio(record, method, error))))
    if method == INITIAL:
        change = np.nan, (np.nan, np.nan)
    return Order(*mesh, method, error, *after, *change, len(means(sizes, lambda record: record.get((method, error)))[0]))


def ratio(record, method, error):
    """The logarithm of the error after over before smoothing; None if one is missing."""
    both = [record.get((which, error)) for which in (method, INITIAL)]
    return None if None in both else both[0] - both[1]


def means(sizes, value):
    """(logarithms of h, means of the values) of the sizes where a seed has a value that is not None."""
    points = []
    for records in sizes.values():
        known = [(record["h"], value(record)) for record in records if value(record) is not None]
        if known:
            points.append(np.mean(known, axis=0))
    return tuple(np.transpose(points)) if points else ((), ())


def changed(found):
    """(cases in which smoothing changes the order on all families, number of all cases). A case is (elements, degree, level, method,
    error). The intervals of the change exclude 0, on the same side, and the changes are larger than LEAST_CHANGE."""
    cases = {}
    for entry in found:
        if np.isfinite(entry.change):
            cases.setdefault((entry.elements, entry.degree, entry.level, entry.method, entry.error), []).append(entry)
    return {case: entries for case, entries in cases.items() if all(is_higher(e) for e in entries) or all(is_lower(e) for e in entries)}, \
        len(cases)


def is_higher(entry):
    """True if smoothing surely raises the order, by more than LEAST_CHANGE."""
    return entry.change_interval[0] > 0 and entry.change > LEAST_CHANGE


def is_lower(entry):
    """The same for a lower order."""
    return entry.change_interval[1] < 0 and entry.change < -LEAST_CHANGE
