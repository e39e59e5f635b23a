# SPDX-License-Identifier: GPL-3.0-or-later
"""What smoothing gains, which method is better, and whether it pays.

One statistic serves order, intervals and tests: the logarithm of the error after over that before smoothing. A family (a domain)
is a unit: its mean over its problems counts once. Levels of distortion stay apart. The first method of the study is the reference
of all comparisons, so that no comparison is chosen by the data."""

from dataclasses import dataclass

import numpy as np

from ..statistics.profiles import time_to_target
from ..statistics.units import geometric, holm, least_p, mean_of_units, sign_flips, unit_means, unit_medians
from ..results.solvers import main_numbers, varying
from .problems import ERROR, LEAST_SECONDS, WORSE, kinds_of_problems, problems_by

NEAR_LEAST = 1.05  # a problem counts as solved below this multiple of the smallest error of any method
SURE = 0.05  # an adjusted p-value below this distinguishes two methods
INITIAL_MESH = "initial"
AS_IS, NEXT_DEGREE, SPLIT = "", "degree", "split"  # changes in addition to smoothing
BUDGETS = (0.25, 1.0, 4.0, 16.0)  # of smoothing, in solutions on the initial mesh


@dataclass(frozen=True)
class Gain:
    """A method on the meshes of one kind: type of elements, degree and level of distortion. Means are over families."""

    elements: str
    degree: str
    level: str
    method: str
    ratio: float  # geometric mean of error / initial error
    interval: tuple
    over_reference: float  # geometric mean of the error over the reference method's
    over_reference_interval: tuple
    p_value: float  # that chance makes the latter as different from 1, adjusted for all methods; NaN for the reference
    seconds: float  # geometric mean of smoothing, over one solution on the initial mesh
    worse: float  # share of problems with an error more than 1 % above the initial one
    failed: float  # share of problems without a result
    n_problems: int
    n_families: int


@dataclass(frozen=True)
class AtBudget:
    """A method's gain within a budget of smoothing time."""

    elements: str
    degree: str
    level: str
    method: str
    budget: float  # in solutions on the initial mesh
    ratio: float
    interval: tuple


@dataclass(frozen=True)
class Payoff:
    """Gain and cost of an alternative to the unsmoothed mesh, as geometric means over families."""

    elements: str
    degree: str
    level: str
    method: str  # INITIAL_MESH: the unsmoothed mesh
    change: str  # of the discretization besides: AS_IS, NEXT_DEGREE or SPLIT
    error: float  # over that of the initial mesh at this degree
    error_interval: tuple
    time: float  # smoothing and solving, over solving on the initial mesh
    time_interval: tuple
    at_equal_time: float  # the error over the unsmoothed mesh's after the same time in all; NaN: not known
    at_equal_time_interval: tuple
    n_problems: int


def mean_ratio(ratios, problems, of_family=unit_means):
    """(geometric mean over families, interval)."""
    return geometric(mean_of_units(np.log(ratios), [problem.family for problem in problems], of_family))


def gains(problems, methods):
    """The gain of every method on every kind of meshes."""
    return [gain for key, of_kind in kinds_of_problems(problems).items() for gain in gains_of_kind(key, of_kind, methods)]


def gains_by_number(results, solver):
    """Column -> gains, of the main numbers of another solver that smoothing changes, and that are positive: ratios of others mean
    nothing."""
    rows = results.summary if len(results.summary) else results.iterations
    columns = [name for name in varying(solver.numbers, rows) if not (rows.number(name) <= 0).any()]
    found = {name: gains(problems_by(results, solver, name), results.methods) for name in main_numbers(columns)}
    return {name: of_number for name, of_number in found.items() if of_number}


def gains_of_kind(key, problems, methods):
    """The gains on one kind of meshes, in the order of the methods."""
    families = [problem.family for problem in problems]
    logs = {method: np.log([problem.ratio(method) for problem in problems]) for method in methods}
    reference = logs[methods[0]]
    p_values = holm([np.nan if method == methods[0] else test_of_units(logs[method] - reference, families) for method in methods])
    found = []
    for method, p_value in zip(methods, p_values):
        ratio, between = geometric(mean_of_units(logs[method], families))
        over, over_between = geometric(mean_of_units(logs[method] - reference, families))
        times = [(np.log(max(p.results[method].seconds, 1e-3 * p.one_solve) / p.one_solve), p.family) for p in problems if method in p.results]
        found.append(Gain(
            *key, method, ratio, between, over, over_between, float(p_value),
            geometric(mean_of_units(*zip(*times), unit_medians))[0] if times else np.nan,
            share(problems, lambda p, m=method: p.ratio(m) > WORSE), share(problems, lambda p, m=method: m not in p.results),
            len(problems), len(set(families))))
    return found


def share(problems, test):
    """Share of problems for which the test is true, as the mean over families."""
    return mean_of_units([float(test(problem)) for problem in problems], [problem.family for problem in problems])[0]


def test_of_units(differences, families):
    """p-value of sign flips of the families' means; NaN for fewer than two families."""
    means = list(unit_means(differences, families).values())
    return sign_flips(means) if len(means) > 1 else np.nan


def can_test(gain, n_methods):
    """True if the number of families could distinguish a method from the reference."""
    return least_p(gain.n_families, n_methods - 1) < SURE


def at_budgets(problems, methods):
    """Gains within budgets, on the kinds of meshes whose errors were recorded on the way."""
    found = []
    for key, of_kind in kinds_of_problems(problems).items():
        of_kind = [problem for problem in of_kind if problem.is_followed]
        for method in methods if of_kind else ():
            for budget in BUDGETS:
                ratios = [problem.ratio_at(method, budget * problem.one_solve) for problem in of_kind]
                found.append(AtBudget(*key, method, budget, *mean_ratio(ratios, of_kind)))
    return found


def solving_costs(problems, methods):
    """Method -> smoothing time until the error is within 5 % of the least of any method, in solutions on the initial mesh; inf:
    never."""
    costs = {method: [] for method in methods}
    for problem in problems:
        least = min(np.min(curve[ERROR]) for curve in problem.curves.values())
        for method in methods:
            curve = problem.curves.get(method)
            reached = np.inf if curve is None else time_to_target(curve["seconds"], curve[ERROR], NEAR_LEAST * least)
            costs[method].append(max(reached, LEAST_SECONDS) / problem.one_solve)
    return {method: np.array(values) for method, values in costs.items()}


def payoffs(problems, methods):
    """Alternatives to the unsmoothed mesh on every kind of meshes: each method's mesh, every cell split, the next degree."""
    by_key = {(problem.member, problem.degree): problem for problem in problems}
    found = []
    for key, of_kind in kinds_of_problems(problems).items():
        collected = {}
        for problem in of_kind:
            for way, (error, seconds, fair) in alternatives(problem, by_key, methods).items():
                collected.setdefault(way, []).append((problem, error / problem.initial.error, seconds / problem.one_solve, fair))
        found += [payoff(key, way, values) for way, values in collected.items()]
    return found


def alternatives(problem, by_key, methods):
    """(method, change) -> (error, seconds in all, error over the unsmoothed mesh's after the same time)."""
    ways = {}
    for method in methods:
        result = problem.results.get(method)
        if result:
            ways[method, AS_IS] = result.error, result.seconds + result.solving
        else:  # the user solves on the initial mesh after all
            ways[method, AS_IS] = problem.initial.error, problem.broken.get(method, 0.0) + problem.one_solve
    higher = by_key.get((problem.member, str(int(problem.degree) + 1)))
    if higher:
        ways[INITIAL_MESH, NEXT_DEGREE] = higher.initial.error, higher.one_solve
    for which, (error, solving) in problem.split.items():
        if which == INITIAL_MESH:
            ways[which, SPLIT] = error, solving
        elif which in methods and which in problem.results:
            ways[which, SPLIT] = error, solving + problem.results[which].seconds
    unsmoothed = error_in_time(problem.initial.error, problem.one_solve, *ways.get((INITIAL_MESH, SPLIT), (np.nan, np.nan)))
    return {way: (error, seconds, np.nan if way[0] == INITIAL_MESH else error / unsmoothed(seconds))
            for way, (error, seconds) in ways.items()}


def error_in_time(error, seconds, split_error, split_seconds):
    """Returns the error as a function of the total time. The power law goes through the error on the mesh and the error with
    every cell split or refined otherwise. NaN unless the second is smaller and takes longer."""
    if not (split_error < error and split_seconds > seconds):
        return lambda time: np.nan
    order = np.log(error / split_error) / np.log(split_seconds / seconds)
    return lambda time: error * (time / seconds)**-order


def payoff(key, way, values):
    """The payoff of an alternative on one kind of meshes."""
    problems, errors, times, fair = zip(*values)
    known = [(ratio, problem) for ratio, problem in zip(fair, problems) if np.isfinite(ratio)]
    return Payoff(*key, *way, *mean_ratio(errors, problems), *mean_ratio(times, problems, unit_medians),
                  *(mean_ratio(*zip(*known), unit_medians) if known else (np.nan, (np.nan, np.nan))), len(values))
