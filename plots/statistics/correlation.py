# SPDX-License-Identifier: GPL-3.0-or-later
"""Rank correlation."""

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
