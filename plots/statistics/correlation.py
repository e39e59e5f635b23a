# SPDX-License-Identifier: GPL-3.0-or-later
"""Rank correlation, and the quality beyond which more of it hardly lowers the error."""

import numpy as np


def ranks(values):
    """Ranks from 1 of finite numbers, shape (n,); equal ones share the mean of their ranks."""
    values = np.asarray(values, dtype=float)
    _, inverse, counts = np.unique(values, return_inverse=True, return_counts=True)
    last = np.cumsum(counts)
    return (last - (counts - 1) / 2.0)[inverse]


def spearman(x, y):
    """Spearman's rank correlation of two arrays of shape (n,), in [-1, 1]; NaN for fewer than three pairs
    and where all numbers of one array are equal. Pairs with a number that is not finite are left out."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    known = np.isfinite(x) & np.isfinite(y)
    if np.count_nonzero(known) < 3:
        return np.nan
    a, b = ranks(x[known]), ranks(y[known])
    a, b = a - a.mean(), b - b.mean()
    norm = np.sqrt((a @ a) * (b @ b))
    return float(a @ b / norm) if norm > 0 else np.nan


def decreasing_fit(x, y):
    """The decreasing step function nearest to points in the sense of least squares (pool adjacent violators): x
    in ascending order without repetitions, and its values there."""
    order = np.argsort(x, kind="stable")
    x, y = np.asarray(x, dtype=float)[order], np.asarray(y, dtype=float)[order]
    steps, first = np.unique(x, return_index=True)
    weights = np.diff(np.append(first, len(x))).astype(float)
    means = np.add.reduceat(y, first) / weights
    pools = []  # mean, weight, number of steps
    for mean, weight in zip(means, weights):
        pools.append([mean, weight, 1])
        while len(pools) > 1 and pools[-2][0] < pools[-1][0]:
            mean_b, weight_b, n_b = pools.pop()
            mean_a, weight_a, n_a = pools.pop()
            weight_ab = weight_a + weight_b
            pools.append([(mean_a * weight_a + mean_b * weight_b) / weight_ab, weight_ab, n_a + n_b])
    return steps, np.concatenate([np.full(n, mean) for mean, _, n in pools])


def good_enough(quality, error, gain=0.05):
    """The least quality from which on the error falls by no more than the fraction `gain`, by the decreasing
    function nearest to log(error); NaN for fewer than three points. Errors positive, both of shape (n,)."""
    quality, error = np.asarray(quality, dtype=float), np.asarray(error, dtype=float)
    known = np.isfinite(quality) & np.isfinite(error) & (error > 0)
    if np.count_nonzero(known) < 3:
        return np.nan
    steps, fitted = decreasing_fit(quality[known], np.log(error[known]))
    enough = fitted - fitted[-1] <= -np.log1p(-gain)
    return float(steps[np.argmax(enough)])
