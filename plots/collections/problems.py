# SPDX-License-Identifier: GPL-3.0-or-later
"""The problems of a collection: one member solved at one degree, on the meshes of every method."""

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..results.rows import SOLVING, Rows, groups_of, solving_seconds
from ..results.smoothing import INITIAL

ERROR = "h1_error"
AS_GENERATED = "as generated"
WORSE = 1.01  # an error above this multiple of the initial mesh's counts as worse
LEAST_SECONDS = 1e-6  # where a clock shows none
MOST_ENDS = 3  # records of a curve without those on the way: initial, result, last


class Result(NamedTuple):
    """The error on a mesh, the time until it was there, and that of solving on it."""

    error: float
    seconds: float
    solving: float


@dataclass(frozen=True)
class Problem:
    """One member at one degree. Arrays have an entry for each record, the initial mesh first."""

    member: str
    family: str  # the unit of all statistics
    elements: str
    mesh: str
    level: str  # of distortion
    degree: str
    initial: Result
    curves: dict  # method -> {"seconds": ..., "solving": ..., "h1_error": ...}
    results: dict  # method -> Result, of methods that return a mesh without invalid cells
    broken: dict  # method -> seconds of its last mesh, for methods that end with invalid cells
    split: dict  # method, or `initial` -> (h1_error, seconds of solving) of its result with every cell split

    def errors(self):
        """Method -> (seconds of smoothing, errors), without records that were not solved."""
        return {name: (curve["seconds"], curve[ERROR]) for name, curve in self.curves.items()}

    @property
    def one_solve(self):
        """Seconds of one solution on the initial mesh: the unit of budgets."""
        return max(self.initial.solving, LEAST_SECONDS)

    def ratio(self, method):
        """The error after over that before smoothing. A method without result leaves the initial mesh: 1."""
        return self.results[method].error / self.initial.error if method in self.results else 1.0

    def ratio_at(self, method, seconds):
        """The same of the mesh that the method has after a smoothing time. Its user does not know the error, so the last
        mesh counts, not the best one. After a method has ended, its result counts; without one, the initial mesh."""
        curve = self.curves.get(method)
        if curve is None or self.broken.get(method, np.inf) <= seconds:
            return 1.0
        if curve["seconds"][-1] <= seconds:
            return self.ratio(method)
        return curve[ERROR][np.searchsorted(curve["seconds"], seconds, side="right") - 1] / self.initial.error

    @property
    def is_followed(self):
        """True if errors were recorded on the way, not at the ends only."""
        return any(len(curve[ERROR]) > MOST_ENDS for curve in self.curves.values())


@lru_cache(maxsize=1)
def problems_of(results):
    """All problems whose initial mesh is solved, in the order of the file."""
    return find_problems(results.iterations, results.summary, results.refined)


def problems_by(results, solver, column):
    """The same with a number of another solver as the error, and with its times. A solver without degrees has one problem a member,
    whose degree is empty."""
    columns = {ERROR: column, **{name: f"{solver.label}.{name}" for name in SOLVING}}

    def of_number(rows):
        if not solver.degrees and len(rows):
            rows = rows.select(degree=min(rows.text("degree")))
            columns["degree"] = ""
        return Rows(rows.path, {**rows.columns, **{name: rows.text(other) for name, other in columns.items()}})
    return find_problems(*map(of_number, (results.iterations, results.summary)), Rows(results.refined.path, {}))


def find_problems(rows, summary, refined):
    """The problems of iterations.csv, summary.csv and refined.csv."""
    errors, seconds, invalid = rows.number(ERROR), smoothing_seconds(rows), rows.number("n_invalid")
    solving, ends, split = solving_seconds(rows), results_of(summary), split_of(refined)
    members, degrees, methods = (rows.text(name) for name in ("member", "degree", "method"))
    places = {}
    for number, key in enumerate(zip(members, degrees)):
        places.setdefault(key, {}).setdefault(methods[number], []).append(number)
    found = []
    for key, of_methods in places.items():
        curves, broken, of_ends = {}, {}, {}
        for method, chosen in of_methods.items():
            chosen = np.array(chosen)
            solved = np.isfinite(errors[chosen])
            if not solved[0]:
                continue
            last, is_broken, is_solved = chosen[-1], invalid[chosen[-1]] > 0, solved[-1]
            if is_broken:
                broken[method] = seconds[last]
            chosen = chosen[solved]
            curves[method] = {"seconds": seconds[chosen], "solving": solving[chosen], ERROR: errors[chosen]}
            # Results of earlier versions have no summary of all members.
            result = ends.get((*key, method)) if ends else None if is_broken or not is_solved else Result(errors[last], seconds[last], solving[last])
            if result is not None:
                of_ends[method] = result
        if curves:
            first = next(iter(of_methods.values()))[0]
            found.append(Problem(
                members[first], rows.text("family")[first], rows.text("elements")[first], rows.text("mesh")[first],
                rows.text("distortion")[first] or AS_GENERATED, degrees[first], Result(errors[first], 0.0, solving[first]),
                curves, of_ends, broken,
                {method: numbers for method, numbers in split.get(key, {}).items() if method == INITIAL or method in curves}))
    return found


def smoothing_seconds(rows):
    """Seconds of smoothing with its preparation, shape (rows,)."""
    return rows.number("smoothing_seconds") + np.nan_to_num(rows.number("preparation_seconds"))


def results_of(summary):
    """(member, degree, method) -> Result, of resulting meshes that were solved and have no invalid cells."""
    if not len(summary):
        return {}
    keys = zip(*(summary.text(name) for name in ("member", "degree", "method")))
    numbers = zip(summary.number(ERROR), smoothing_seconds(summary), solving_seconds(summary))
    return {key: Result(*number) for key, number, invalid in zip(keys, numbers, summary.number("n_invalid"))
            if key[2] != INITIAL and np.isfinite(number[0]) and invalid == 0}


def split_of(refined):
    """(member, degree) -> {method: (error, seconds of solving)}."""
    found = {}
    for member, degree, method, error, seconds in zip(
            *(refined.text(name) for name in ("member", "degree", "method")), refined.number(ERROR), solving_seconds(refined)):
        if np.isfinite(error):
            found.setdefault((member, degree), {})[method] = error, seconds
    return found


def kinds_of_meshes(rows):
    """(elements, degree) that occur in rows that were solved, sorted."""
    return sorted(key for key, _ in groups_of(rows.where(rows.text("degree") != ""), "elements", "degree"))


def kinds_of_problems(problems):
    """(elements, degree, level) -> problems, sorted; meshes as generated come first."""
    found = {}
    for problem in problems:
        found.setdefault((problem.elements, problem.degree, problem.level), []).append(problem)
    return dict(sorted(found.items(), key=lambda entry: (*entry[0][:2], entry[0][2] != AS_GENERATED, -level_number(entry[0][2]))))


def level_number(level):
    """The mean quality of a level of distortion, to sort by."""
    return float(level) if level != AS_GENERATED else 1.0
