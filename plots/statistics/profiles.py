# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparing methods over many problems: performance profiles, times to targets, anytime curves."""

import numpy as np


def performance_profile(costs):
    """Dolan and More (2002): for each method the ratios of its costs to the least cost of any method, ascending,
    and the share of problems solved within each; {method: (ratios, shares)}.

    costs: {method: array of shape (n_problems,)}, positive; NaN or inf where a method has not solved a problem.
    Problems that no method solves count, as solved by none."""
    names = list(costs)
    table = np.array([np.where(np.isfinite(costs[name]), costs[name], np.inf) for name in names], dtype=float)
    least = table.min(axis=0)
    with np.errstate(invalid="ignore"):
        ratios = np.where(np.isfinite(table), table / least, np.inf)
    profile = {}
    for name, own in zip(names, ratios):
        solved = np.sort(own[np.isfinite(own)])
        profile[name] = solved, np.arange(1, len(solved) + 1) / max(1, table.shape[1])
    return profile


def time_to_target(times, errors, target):
    """The first of ascending times at which the error is at or below the target; inf if it never is."""
    reached = np.flatnonzero(np.asarray(errors) <= target)
    return float(np.asarray(times)[reached[0]]) if len(reached) else np.inf


def targets_of(curves, n_targets=10):
    """Targets for one problem, from the errors themselves: n_targets errors, equally spaced in logarithm, from the
    initial error (not one of them) down to the least that any method reaches (the last one). curves: {method:
    (times, errors)}, each beginning with the initial mesh. Empty if none falls below the initial error."""
    initial = max(errors[0] for _, errors in curves.values())
    least = min(np.min(errors) for _, errors in curves.values())
    if not least < initial:
        return np.array([])
    return np.geomspace(initial, least, n_targets + 1)[1:] * (1.0 + 1e-12)


def runtime_distribution(problems, n_targets=10):
    """COCO's data: for each method the times at which it reaches the targets of all problems (inf: never), one for
    each problem and target; {method: array of shape (n_pairs,)}. problems: list of curves (see targets_of)."""
    names = list(dict.fromkeys(name for curves in problems for name in curves))
    reached = {name: [] for name in names}
    for curves in problems:
        for target in targets_of(curves, n_targets):
            for name in names:
                times, errors = curves.get(name, ([], []))
                reached[name].append(time_to_target(times, errors, target))
    return {name: np.array(times) for name, times in reached.items()}


def anytime(problems, method, grid):
    """Median and quartiles, over the problems, of the error over the initial one, at each time of the grid; shape
    (3, len(grid)): lower quartile, median, upper quartile. Before its first record a method has the initial
    error."""
    rows = []
    for curves in problems:
        if method not in curves:
            continue
        times, errors = (np.asarray(values, dtype=float) for values in curves[method])
        ratios = errors / errors[0]
        at = np.searchsorted(times, grid, side="right") - 1
        rows.append(np.where(at >= 0, ratios[np.maximum(at, 0)], 1.0))
    return np.percentile(np.array(rows), [25, 50, 75], axis=0) if rows else np.full((3, len(grid)), np.nan)
