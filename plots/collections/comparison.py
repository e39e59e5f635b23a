# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparison of methods on all problems, at equal budgets of time: which is better, and whether smoothing pays."""

from dataclasses import dataclass

import numpy as np

from ..statistics.bootstrap import interval, paired_test
from ..statistics.profiles import ranks_of_problems, time_to_target
from .problems import ERROR

N_SAMPLES = 500
NEAR_LEAST = 1.05  # a problem counts as solved below this multiple of the smallest error of any method
INITIAL_MESH = "initial"
AS_IS, NEXT_DEGREE, SPLIT = "", "degree", "split"  # changes in addition to smoothing


@dataclass(frozen=True)
class Rank:
    """A method among the others."""

    method: str
    rank: float  # mean over the problems, 1 is best
    rank_interval: tuple
    ratio: float  # geometric mean of error / initial error at the budget
    ratio_interval: tuple
    p_value: float  # of the paired test against the best method; NaN for that one
    n_groups: int  # families or meshes that the test swaps together


@dataclass(frozen=True)
class Shared:
    """Problems on which methods can be compared: each of the methods has a result on each of them."""

    problems: tuple
    methods: tuple  # that are compared
    missing: dict  # method -> number of all problems on which it has no result, where there are any
    n_all: int  # problems


@dataclass(frozen=True)
class Payoff:
    """Gains and costs of a method in a family at a degree, as geometric means over its problems."""

    family: str
    degree: str
    method: str  # INITIAL_MESH: the unsmoothed mesh
    change: str  # of the discretization besides: AS_IS, NEXT_DEGREE or SPLIT
    error: float  # over that of the initial mesh at this degree
    error_interval: tuple
    time: float  # smoothing and solving, over solving on the initial mesh
    at_equal_time: float  # median of the error over the unsmoothed mesh's after the same time in all; NaN: not known
    at_equal_time_interval: tuple
    n_problems: int


def has_result(problem, method):
    """True if the method has reached its end without invalid cells."""
    return method in problem.curves and method not in problem.broken


def shared_problems(problems, methods):
    """Returns the problems on which all methods have a result. If there are none, the methods with the fewest results are left out
    one by one."""
    missing = {method: sum(not has_result(problem, method) for problem in problems) for method in methods}
    compared = [method for method in methods if missing[method] < len(problems)]
    while True:
        shared = [problem for problem in problems if all(has_result(problem, method) for method in compared)]
        if shared or not compared:
            break
        compared.remove(max(compared, key=lambda method: missing[method]))
    return Shared(tuple(shared) if compared else (), tuple(compared), {method: n for method, n in missing.items() if n}, len(problems))


def results_alone(shared):
    """(method, geometric mean of resulting over initial error), the smallest first: whatever the methods' times."""
    ratios = {method: geometric_mean(np.array([problem.curves[method][ERROR][-1] / problem.curves[method][ERROR][0]
                                               for problem in shared.problems])) for method in shared.methods if shared.problems}
    return sorted(ratios.items(), key=lambda entry: entry[1])


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
    """Returns {method: error over the initial error} at a budget of time, the median total time of the methods.

    The value is 1 if the method has no better mesh by then or ends with invalid cells: the initial mesh is used instead."""
    errors = {method: [] for method in methods}
    for problem in problems:
        budget = np.median([curve["seconds"][-1] for curve in problem.curves.values()])
        for method in methods:
            curve = problem.curves.get(method)
            if curve is None or problem.broken.get(method, np.inf) <= budget:
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
    ranks = ranks_of_problems(errors)
    best = min(methods, key=lambda method: np.mean(ranks[method]))
    found = [Rank(
        method, float(np.mean(ranks[method])), interval(lambda rows, m=method: np.mean(ranks[m][rows]), groups, N_SAMPLES),
        geometric_mean(errors[method]),
        interval(lambda rows, m=method: geometric_mean(errors[m][rows]), groups, N_SAMPLES),
        np.nan if method == best else paired_test(np.log(errors[method]), np.log(errors[best]), groups), len(set(groups)))
        for method in methods]
    return sorted(found, key=lambda entry: entry.rank)


def payoffs(problems, methods, all_problems=None):
    """Returns the payoffs of every method in every family at every degree, without changes and with every cell split. The unsmoothed
    mesh also has the next degree, which is looked up in all_problems (default: problems)."""
    by_key = {(problem.member, problem.degree): problem for problem in all_problems or problems}
    collected = {}
    for problem in problems:
        first = next(iter(problem.curves.values()))
        error, seconds = first[ERROR][0], max(first["solving"][0], 1e-6)
        options = {(method, AS_IS): (curve[ERROR][-1], curve["seconds"][-1] + curve["solving"][-1])
                   for method, curve in problem.curves.items() if method not in problem.broken}
        higher = by_key.get((problem.member, str(int(problem.degree) + 1)))
        if higher:
            of_higher = next(iter(higher.curves.values()))
            options[INITIAL_MESH, NEXT_DEGREE] = of_higher[ERROR][0], of_higher["solving"][0]
        for method, (split_error, solving) in problem.split.items():
            smoothing = 0.0 if method == INITIAL_MESH else problem.curves[method]["seconds"][-1]
            options[method, SPLIT] = split_error, smoothing + solving
        unsmoothed = error_in_time(error, seconds, *options.get((INITIAL_MESH, SPLIT), (np.nan, np.nan)))
        for (method, change), (its_error, its_seconds) in options.items():
            if method in (*methods, INITIAL_MESH):
                collected.setdefault((problem.family, problem.degree, method, change), []).append(
                    (problem.mesh, its_error / error, its_seconds / seconds,
                     np.nan if method == INITIAL_MESH else its_error / unsmoothed(its_seconds)))
    return [payoff(*key, values) for key, values in sorted(collected.items())]


def error_in_time(error, seconds, split_error, split_seconds):
    """Returns the error as a function of the total time. The power law goes through the error on the mesh and the error with
    every cell split or refined otherwise. NaN unless the second is smaller and takes longer."""
    if not (split_error < error and split_seconds > seconds):
        return lambda time: np.nan
    order = np.log(error / split_error) / np.log(split_seconds / seconds)
    return lambda time: error * (time / seconds)**-order


def payoff(family, degree, method, change, values):
    """Computes the payoff in one family; intervals are drawn from its meshes."""
    meshes, errors, times, at_equal_time = (np.array(column) for column in zip(*values))
    meshes, known = meshes.astype(str), np.isfinite(at_equal_time)
    return Payoff(family, degree, method, change, geometric_mean(errors),
                  interval(lambda rows: geometric_mean(errors[rows]), meshes, N_SAMPLES), geometric_mean(times),
                  float(np.median(at_equal_time[known])) if known.any() else np.nan,
                  interval(lambda rows: np.median(at_equal_time[known][rows]), meshes[known], N_SAMPLES)
                  if known.any() else (np.nan, np.nan), len(values))


def geometric_mean(values):
    """The geometric mean of positive numbers."""
    return float(np.exp(np.mean(np.log(np.maximum(values, 1e-300)))))
