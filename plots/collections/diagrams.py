# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparison of methods over all problems of a collection, as curves."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..statistics.profiles import anytime, performance_profile, runtime_distribution
from .comparison import solving_costs
from .problems import problems_of

N_TIMES = 100  # of anytime curves
LEAST_TIME = 1e-6  # axes of time are logarithmic
DIAGRAMS = {"profile": "performance profiles", "runtime": "time to targets", "anytime": "error against time"}
SOLUTIONS = "Smoothing time / one solution on the initial mesh"


@dataclass(frozen=True)
class Curve:
    """The curve of one method; arrays of the same length, x ascending. lower, upper: quartiles, or None."""

    method: str
    x: np.ndarray
    y: np.ndarray
    lower: np.ndarray = None
    upper: np.ndarray = None


@dataclass(frozen=True)
class Diagram:
    """Curves of methods; horizontal axes are logarithmic. is_share: y is a share of problems, which rises in steps."""

    x_label: str
    y_label: str
    is_share: bool
    curves: tuple


@lru_cache(maxsize=1)
def diagrams(results):
    """The DIAGRAMS that have curves: name -> Diagram."""
    problems = problems_of(results)
    found = {"profile": profile(problems, results.methods), "runtime": runtime(problems),
             "anytime": errors_so_far(problems, results.methods)}
    return {name: diagram for name, diagram in found.items() if diagram.curves}


def curves_of(problem):
    """Method -> (smoothing time in solutions on the initial mesh, errors)."""
    return {name: (seconds / problem.one_solve, errors) for name, (seconds, errors) in problem.errors().items()}


def profile(problems, methods):
    """Dolan and More's profiles of the time to an error within 5 % of the least."""
    curves = performance_profile(solving_costs(problems, methods))
    return Diagram("Smoothing time / least of any method", "Share of problems solved", True,
                   tuple(Curve(method, x, share) for method, (x, share) in curves.items() if len(x)))


def runtime(problems):
    """COCO's distributions of runtimes to targets."""
    curves = []
    for method, times in runtime_distribution([curves_of(problem) for problem in problems]).items():
        reached = np.sort(times[np.isfinite(times)])
        if len(reached):
            curves.append(Curve(method, np.maximum(reached, LEAST_TIME), np.arange(1, len(reached) + 1) / len(times)))
    return Diagram(SOLUTIONS, "Share of problems and targets", True, tuple(curves))


def errors_so_far(problems, methods):
    """Median and quartiles of the error over the initial one, of problems whose errors were recorded on the way."""
    errors = [curves_of(problem) for problem in problems if problem.is_followed]
    ends = [times[-1] for curves in errors for times, _ in curves.values() if times[-1] > 0]
    curves = []
    if ends:
        grid = np.geomspace(max(min(ends) / 10, LEAST_TIME), max(ends), N_TIMES)
        for method in methods:
            lower, median, upper = anytime(errors, method, grid)
            curves.append(Curve(method, grid, median, lower, upper))
    return Diagram(SOLUTIONS, "H1 error / initial", False, tuple(curves))
