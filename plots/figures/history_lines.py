# SPDX-License-Identifier: GPL-3.0-or-later
"""Content of a panel of a history, before it is drawn: a line for each method, and the range of its horizontal axis."""

from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from ..results.request import TIME
from ..results.smoothing import INITIAL

# Of the mesh, hence the same for every degree.
QUALITY = ("q_min", "q_star_min", "q_mean", "w_max", "w_mean", "n_invalid", "n_reset", TIME, "iteration")
COUNTS = ("iteration", "n_solves")  # whole numbers
FROM_ZERO = (TIME, *COUNTS)  # columns that start at zero

# One method that takes so many times as long as every other would squeeze all of them into a line:
# then a linear axis ends at so many times the second longest time, and says when that one ends.
DOMINANT_FROM, SHOWN_OF_DOMINANT = 20.0, 5.0

MARGIN = 0.02  # of the range, on both sides
# On a logarithmic axis zero has its place at the left, so much of the range before the first number.
PLACE_OF_ZERO = 0.06


@dataclass(frozen=True)
class Line:
    """One method on one mesh: an entry for each of its records, in their order. Numbers are NaN, and
    the line has a gap, where the mesh is invalid or the file has none."""

    x: np.ndarray
    y: np.ndarray
    valid: np.ndarray  # whether the record's mesh is
    result: Optional[int] = None  # which record is that of the resulting mesh

    @property
    def shown(self):
        """A mask of the records that can be drawn."""
        return np.isfinite(self.x) & np.isfinite(self.y)

    @property
    def invalid_after(self):
        """The last record shown before all meshes are invalid; None if it does not come to that."""
        before = np.flatnonzero(self.shown & self.valid)
        return None if self.valid[-1] or not len(before) else int(before[-1])

    @property
    def gaps(self):
        """Records without a number between two with one, as (record before, records of the gap, record after)."""
        shown = np.flatnonzero(self.shown)
        return [(before, np.arange(before + 1, after), after) for before, after in zip(shown[:-1], shown[1:])
                if after > before + 1 and not self.valid[before + 1:after].all()]

    @property
    def is_never_valid(self):
        """True if no mesh is valid except, perhaps, the initial one."""
        return not (self.valid[1:] if len(self.valid) > 1 else self.valid).any()


def depends_on_degree(results, column):
    """False for numbers of the mesh, and for those of a solver without degrees."""
    return column not in QUALITY and not any(column in solver.columns and not solver.degrees for solver in results.solvers)


def panel_lines(results, name, mesh, degree, x=TIME):
    """Method -> Line of a column against column `x`, on one mesh."""
    rows = results.iterations.select(mesh=mesh)
    if not depends_on_degree(results, name):
        degree = next((d for d in rows.text("degree")), degree)
    rows = rows.select(degree=degree)
    lines = {}
    for method in (*results.methods, INITIAL):
        chosen = rows.select(method=method)
        if len(chosen):
            valid = ~(chosen.number("n_invalid") > 0)
            values = chosen.number(name)
            # How many cells are invalid is known of invalid meshes, too.
            y = values if name in ("n_invalid", "n_reset") else np.where(valid, values, np.nan)
            lines[method] = Line(chosen.number(x), y, valid,
                                 None if method == INITIAL else results.result_record(chosen))
    return lines


@dataclass(frozen=True)
class Range:
    """The range of a horizontal axis."""

    low: float
    high: float
    logarithmic: bool = False
    zero: Optional[float] = None  # where zero has its place on a logarithmic axis; None: nowhere
    dominant: str = ""  # the one method that goes on beyond the end

    def placed(self, x):
        """Positions of numbers on the axis; NaN for numbers that the axis cannot show."""
        if not self.logarithmic:
            return x
        place = np.nan if self.zero is None else self.zero
        return np.where(x == 0, place, np.where(x > 0, x, np.nan))

    def holds(self, x):
        """A mask of the placed numbers that lie on the axis."""
        with np.errstate(invalid="ignore"):
            return ~(x > self.high) & ~(x < self.low)

    def limited(self, limits):
        """The range with other ends: (from, to), None where an end stays."""
        low, high = (own if end is None else end for own, end in zip((self.low, self.high), limits))
        if self.logarithmic and low <= 0:
            low = self.low
        if limits[0] is None and low < 0 < high:
            low = max(low, -MARGIN * high)  # the margin of a shorter axis
        return replace(self, low=low, high=high, zero=self.zero if limits[0] is None else None,
                       dominant="" if limits[1] is not None else self.dominant)


def range_of(panels, logarithmic, x=TIME):
    """The Range of the lines that are drawn in panels below each other, each a result of panel_lines
    against column `x`."""
    drawn = [(method, line.x[line.shown]) for lines in panels for method, line in lines.items()
             if method != INITIAL and line.shown.any()]
    numbers = np.concatenate([values for _, values in drawn]) if drawn else np.array([0.0, 1.0])
    if logarithmic and (numbers > 0).any():
        return logarithmic_range(numbers)
    if x not in FROM_ZERO:
        margin = MARGIN * (np.ptp(numbers) or 1.0)
        return Range(numbers.min() - margin, numbers.max() + margin)
    ends = {}
    for method, values in drawn:
        ends[method] = max(ends.get(method, 0.0), values.max())
    dominant, limit = dominant_method(ends) if x == TIME else ("", np.inf)
    last = max(ends.values(), default=0.0) or 1.0
    return Range(-MARGIN * min(last, limit), min((1 + MARGIN) * last, limit), dominant=dominant)


def logarithmic_range(numbers):
    """A range that holds all positive numbers, and a place for zero if that is among them."""
    positive = numbers[numbers > 0]
    span = max(positive.max() / positive.min(), 10.0)
    has_zero = bool((numbers == 0).any())
    first = positive.min() / (span**PLACE_OF_ZERO if has_zero else 1.0)
    return Range(first / span**MARGIN, positive.max() * span**MARGIN, True, first if has_zero else None)


def dominant_method(ends):
    """(method, where the axis ends) if one method takes far longer than all others, else no name and
    an infinite number; `ends` maps methods to the last number of their lines."""
    ordered = sorted((end, method) for method, end in ends.items())
    if len(ordered) < 2 or not 0 < DOMINANT_FROM * ordered[-2][0] < ordered[-1][0]:
        return "", np.inf
    return ordered[-1][1], SHOWN_OF_DOMINANT * ordered[-2][0]
