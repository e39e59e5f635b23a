# SPDX-License-Identifier: GPL-3.0-or-later
"""Intervals and tests by resampling. Rows that belong together, as those of one mesh, are drawn together:
otherwise many records of few meshes would look like much evidence."""

import numpy as np

N_SAMPLES = 1000
LEVEL = 0.95


def interval(statistic, groups, n_samples=N_SAMPLES, level=LEVEL, seed=1):
    """Bootstrap interval (percentiles) of statistic(rows), where rows are those of groups drawn with repetition;
    (low, high), NaN where fewer than two groups give no interval.

    groups: shape (n,), what each row belongs to. statistic: takes indices of rows, returns a number."""
    return intervals(lambda rows: [statistic(rows)], 1, groups, n_samples, level, seed)[0]


def intervals(statistics, n_statistics, groups, n_samples=N_SAMPLES, level=LEVEL, seed=1):
    """Intervals of several statistics that are computed together, from the same draws. statistics: takes indices of
    rows, returns n_statistics numbers."""
    groups = np.asarray(groups)
    _, inverse = np.unique(groups, return_inverse=True)
    members = [np.flatnonzero(inverse == g) for g in range(inverse.max(initial=-1) + 1)]
    if len(members) < 2:
        return [(np.nan, np.nan)] * n_statistics
    random = np.random.default_rng(seed)
    values = []
    for _ in range(n_samples):
        drawn = random.integers(len(members), size=len(members))
        values.append(statistics(np.concatenate([members[g] for g in drawn])))
    tail = 50.0 * (1.0 - level)
    found = []
    for column in np.asarray(values, dtype=float).T:
        column = column[np.isfinite(column)]
        found.append(tuple(float(v) for v in np.percentile(column, [tail, 100.0 - tail])) if len(column) else (np.nan, np.nan))
    return found


def paired_test(a, b, groups=None, n_samples=10000, seed=1):
    """Probability of a mean difference of pairs as large as that of a and b, in absolute value, if chance decided which
    of a pair belongs to a and which to b (sign flips; all of them for up to 13 that differ). 1 if no pair differs. a,
    b: shape (n,), finite. groups: shape (n,), pairs of a group are swapped together (default: each pair is its own
    group)."""
    difference = np.asarray(a, dtype=float) - np.asarray(b, dtype=float)
    if groups is not None:
        _, inverse = np.unique(np.asarray(groups), return_inverse=True)
        difference = np.bincount(inverse, weights=difference)
    difference = difference[difference != 0]
    n = len(difference)
    if n == 0:
        return 1.0
    if n <= 13:
        signs = 1.0 - 2.0 * ((np.arange(2**n)[:, None] >> np.arange(n)) & 1)
        sums = np.abs(signs @ difference)
    else:
        random = np.random.default_rng(seed)
        sums = np.abs([random.choice((-1.0, 1.0), size=n) @ difference for _ in range(n_samples)])
    reached = np.count_nonzero(sums >= abs(difference.sum()) * (1.0 - 1e-12))
    return float(reached / len(sums)) if n <= 13 else float((reached + 1) / (len(sums) + 1))
