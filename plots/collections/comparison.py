# SPDX-License-Identifier: GPL-3.0-or-later
"""Which method is better, and whether smoothing pays: on all problems, at equal budgets of time."""

from dataclasses import dataclass

import numpy as np

from ..statistics.bootstrap import interval, paired_test
from ..statistics.profiles import mean_ranks, time_to_target
from .problems import ERROR

N_SAMPLES = 500
NEAR_LEAST = 1.05  # of the least error that any method reaches: a problem that is solved
INITIAL_MESH = "initial"


@dataclass(frozen=True)
class Rank:
    """A method among the others."""

    method: str
    rank: float  # mean over the problems, 1 is best
    rank_interval: tuple
    ratio: float  # geometric mean of error / initial error at the budget
    ratio_interval: tuple
    p_value: float  # of the paired test against the best method; NaN for that one


@dataclass(frozen=True)
class Payoff:
    """What a method gains and costs in a family at a degree, in geometric means over its problems."""

    family: str
    degree: str
    method: str  # INITIAL_MESH: the unsmoothed mesh at the next degree
    error: float  # over that of the initial mesh at this degree
    error_interval: tuple
    time: float  # smoothing and solving, over solving on the initial mesh
    n_problems: int


def solving_costs(problems, methods):
    """Method -> seconds of smoothing until the error is within 5 % of the least of any method; inf: never."""
    costs = {method: [] for method in methods}
    for problem in problems:
        least = min(np.min(curve[ERROR]) for curve in problem.curves.values())
        for method in methods:
            curve = problem.curves.get(method)
            reached = np.inf if curve is None else time_to_target(curve["seconds"], curve[ERROR], NEAR_LEAST * least)
            costs[method].append(max(reached, 1e-6))
    return {method: np.array(values) for method, values in costs.items()}


def errors_at_budget(problems, methods):
    """Method -> error over the initial one, with the time that the middle one of the methods takes in all; 1 where
    the method has nothing better by then."""
    errors = {method: [] for method in methods}
    for problem in problems:
        budget = np.median([curve["seconds"][-1] for curve in problem.curves.values()])
        for method in methods:
            curve = problem.curves.get(method)
            if curve is None:
                errors[method].append(1.0)
                continue
            in_time = curve[ERROR][curve["seconds"] <= budget]
            errors[method].append(np.min(in_time, initial=curve[ERROR][0]) / curve[ERROR][0])
    return {method: np.array(values) for method, values in errors.items()}


def ranking(problems, methods):
    """The methods by mean rank of their errors at equal budgets, the best first."""
    if not problems:
        return []
    errors = errors_at_budget(problems, methods)
    groups = np.array([problem.group for problem in problems], dtype=str)
    ranks = mean_ranks(errors)
    best = min(methods, key=ranks.get)
    found = [Rank(
        method, ranks[method],
        interval(lambda rows, m=method: mean_ranks({k: v[rows] for k, v in errors.items()})[m], groups, N_SAMPLES // 5),
        geometric_mean(errors[method]),
        interval(lambda rows, m=method: geometric_mean(errors[m][rows]), groups, N_SAMPLES),
        np.nan if method == best else paired_test(np.log(errors[method]), np.log(errors[best])))
        for method in methods]
    return sorted(found, key=lambda entry: entry.rank)


def payoffs(problems, methods):
    """Every method in every family at every degree, and the unsmoothed mesh at the next degree."""
    by_key = {(problem.member, problem.degree): problem for problem in problems}
    collected = {}
    for problem in problems:
        first = next(iter(problem.curves.values()))
        error, seconds = first[ERROR][0], max(first["solving"][0], 1e-6)
        for method in methods:
            if method in problem.curves:
                curve = problem.curves[method]
                note(collected, problem, method, curve[ERROR][-1] / error,
                     (curve["seconds"][-1] + curve["solving"][-1]) / seconds)
        higher = by_key.get((problem.member, str(int(problem.degree) + 1)))
        if higher:
            first = next(iter(higher.curves.values()))
            note(collected, problem, INITIAL_MESH, first[ERROR][0] / error, first["solving"][0] / seconds)
    return [payoff(*key, values) for key, values in sorted(collected.items())]


def note(collected, problem, method, error, time):
    """Adds one problem's numbers."""
    collected.setdefault((problem.family, problem.degree, method), []).append((problem.mesh, error, time))


def payoff(family, degree, method, values):
    """Of one family; its meshes are what intervals draw."""
    meshes, errors, times = (np.array(column) for column in zip(*values))
    return Payoff(family, degree, method, geometric_mean(errors),
                  interval(lambda rows: geometric_mean(errors[rows]), meshes.astype(str), N_SAMPLES),
                  geometric_mean(times), len(values))


def geometric_mean(values):
    """Of positive numbers."""
    return float(np.exp(np.mean(np.log(np.maximum(values, 1e-300)))))
