# SPDX-License-Identifier: GPL-3.0-or-later
"""Straight lines by least squares."""

import numpy as np

from .units import LEVEL

FEWEST_POINTS = 3  # of a line with an interval


def slope(x, y, level=LEVEL):
    """(slope, (low, high)) of the line through points, with the interval by Student's t distribution for independent errors of y; NaN
    for fewer than three points. x, y: shape (n,), finite; x not all equal."""
    from scipy.special import stdtrit  # takes a tenth of a second to load
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    n = len(x)
    if n < FEWEST_POINTS:
        return np.nan, (np.nan, np.nan)
    centred = x - x.mean()
    spread = centred @ centred
    found = float(centred @ y / spread)
    rest = y - y.mean() - found * centred
    half = float(stdtrit(n - 2, 0.5 + 0.5 * level) * np.sqrt(rest @ rest / (n - 2) / spread))
    return found, (found - half, found + half)
