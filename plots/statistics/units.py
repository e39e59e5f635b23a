# SPDX-License-Identifier: GPL-3.0-or-later
"""Means over units, such as domains: values of one unit are no independent evidence, so each unit counts once."""

import numpy as np

LEVEL = 0.95
MOST_EXACT = 16  # differences whose signs are all tried


def unit_means(values, units):
    """{unit: mean of its values}, sorted by unit. values, units: shape (n,)."""
    names, inverse = np.unique(np.asarray(units, dtype=str), return_inverse=True)
    values = np.asarray(values, dtype=float)
    return dict(zip(names, np.bincount(inverse, weights=values) / np.bincount(inverse))) if len(names) else {}


def unit_medians(values, units):
    """{unit: median of its values}, sorted by unit: for times, which other work on the machine makes too long now and then."""
    units, values = np.asarray(units, dtype=str), np.asarray(values, dtype=float)
    return {str(name): float(np.median(values[units == name])) for name in np.unique(units)}


def mean_of_units(values, units, of_unit=unit_means):
    """(mean of the units' means, interval by Student's t distribution); NaN where there is no unit, or for the interval
    less than two."""
    means = np.array(list(of_unit(values, units).values()))
    mean = float(means.mean()) if len(means) else np.nan
    return mean, t_interval(means)


def t_interval(values, level=LEVEL):
    """(low, high) for the mean of independent values; NaN for fewer than two."""
    from scipy.special import stdtrit  # takes a tenth of a second to load
    values = np.asarray(values, dtype=float)
    if len(values) < 2:
        return np.nan, np.nan
    half = stdtrit(len(values) - 1, 0.5 + 0.5 * level) * values.std(ddof=1) / np.sqrt(len(values))
    return float(values.mean() - half), float(values.mean() + half)


def geometric(mean_and_interval):
    """The same of numbers whose logarithms were averaged."""
    mean, (low, high) = mean_and_interval
    return float(np.exp(mean)), (float(np.exp(low)), float(np.exp(high)))


def sign_flips(differences, n_samples=10000, seed=1):
    """Probability of a mean as far from 0 as that of the differences if chance decided the sign of each: all signs for up to 16
    differences that are not 0, otherwise n_samples random ones. 1 if all are 0. differences: shape (n,), finite."""
    differences = np.asarray(differences, dtype=float)
    differences = differences[differences != 0]
    n = len(differences)
    if n == 0:
        return 1.0
    if n <= MOST_EXACT:
        signs = 1.0 - 2.0 * ((np.arange(2**n)[:, None] >> np.arange(n)) & 1)
    else:
        signs = np.random.default_rng(seed).choice((-1.0, 1.0), size=(n_samples, n))
    reached = np.count_nonzero(np.abs(signs @ differences) >= abs(differences.sum()) * (1.0 - 1e-12))
    return float(reached / len(signs)) if n <= MOST_EXACT else float((reached + 1) / (len(signs) + 1))


def holm(p_values):
    """p-values adjusted for the number of tests (Holm 1979), in their order; NaN stays and counts as no test."""
    p_values = np.asarray(p_values, dtype=float)
    adjusted = np.full(len(p_values), np.nan)
    order = [k for k in np.argsort(p_values) if np.isfinite(p_values[k])]
    largest = 0.0
    for done, k in enumerate(order):
        largest = max(largest, min(1.0, (len(order) - done) * p_values[k]))
        adjusted[k] = largest
    return adjusted


def least_p(n_units, n_tests):
    """The least adjusted p-value that sign flips of this many units can give in this many tests."""
    return min(1.0, n_tests * 2.0 / 2.0**n_units)
