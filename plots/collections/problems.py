# SPDX-License-Identifier: GPL-3.0-or-later
"""The problems of a collection: one member solved at one degree, on the meshes of every method."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..results.rows import groups_of, solving_seconds
from ..results.smoothing import INITIAL

LEAST_FAMILIES = 5  # to draw families for intervals; fewer say too little, and meshes are drawn
ERROR = "h1_error"


@dataclass(frozen=True)
class Problem:
    """Curves of one member at one degree; arrays have an entry for each record, the initial mesh first."""

    member: str
    family: str
    elements: str
    mesh: str
    group: str  # what intervals draw it with: the family or the mesh
    degree: str
    curves: dict  # method -> {"seconds": ..., "solving": ..., "h1_error": ...}
    broken: dict  # method -> seconds of its last mesh, for methods that end with invalid cells
    split: dict  # method, or `initial` -> (h1_error, seconds of solving) of its result with every cell split

    def errors(self):
        """Method -> (seconds of smoothing, errors), without records that were not solved."""
        return {name: (curve["seconds"], curve[ERROR]) for name, curve in self.curves.items()}


def group_column(rows):
    """By which column intervals draw: families if there are enough of them, else meshes."""
    return "family" if len(set(rows.text("family"))) >= LEAST_FAMILIES else "mesh"


@lru_cache(maxsize=1)
def problems_of(results):
    """All problems whose initial mesh is solved, in the order of the file."""
    rows = results.iterations
    by = group_column(rows)
    numbers = {name: rows.number(name) for name in ("smoothing_seconds", "preparation_seconds", ERROR)}
    seconds = numbers["smoothing_seconds"] + numbers["preparation_seconds"]
    solving, invalid = solving_seconds(rows), rows.number("n_invalid")
    split = split_of(results.refined)
    members, degrees, methods = (rows.text(name) for name in ("member", "degree", "method"))
    places = {}
    for number, key in enumerate(zip(members, degrees)):
        if key[1]:
            places.setdefault(key, {}).setdefault(methods[number], []).append(number)
    found = []
    for (member, degree), of_methods in places.items():
        curves, broken = {}, {}
        for method, chosen in of_methods.items():
            chosen = np.array(chosen)
            solved = np.isfinite(numbers[ERROR][chosen])
            if solved[0]:
                if invalid[chosen[-1]] > 0:
                    broken[method] = seconds[chosen[-1]]
                chosen = chosen[solved]
                curves[method] = {"seconds": seconds[chosen], "solving": solving[chosen],
                                  ERROR: numbers[ERROR][chosen]}
        if curves:
            first = next(iter(of_methods.values()))[0]
            found.append(Problem(member, rows.text("family")[first], rows.text("elements")[first],
                                 rows.text("mesh")[first], rows.text(by)[first], degree, curves, broken,
                                 {method: numbers for method, numbers in split.get((member, degree), {}).items()
                                  if method == INITIAL or method in curves}))
    return found


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
