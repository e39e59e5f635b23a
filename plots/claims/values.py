# SPDX-License-Identifier: GPL-3.0-or-later
"""Provides values for claims: columns of summary.csv and thresholds.csv by name, and the functions of iterations.csv
below. The same names give the printed values, if the thesis prints them."""

import numpy as np

from ..results.smoothing import INITIAL
from .expressions import Missing

KEYS_OF_THRESHOLDS = ("mesh", "degree", "error", "method")
COLUMNS_OF_THRESHOLDS = ("threshold", "reference_seconds", "method_seconds", "speedup")
NEVER = {"method_seconds": "inf", "speedup": "0"}


class Values:
    """Numbers by name and arguments.

    `column(mesh, method)` or `column(mesh, method, degree)`: a column of the summary;
    `column(mesh, degree, error, method)`: one of the thresholds, or `reached`: 1 or 0.
    Also `column(name, mesh, method, degree)` for a column whose name varies, `min` and `max`.
    """

    def __init__(self, summary, thresholds, iterations=None):
        self.summary, self.thresholds, self.iterations = summary, thresholds, iterations

    def __call__(self, name, arguments):
        if name in ("min", "max"):
            return min(arguments) if name == "min" else max(arguments)
        arguments = [str(argument) for argument in arguments]
        if name == "column":
            name, *arguments = arguments
        if name in TRAJECTORY:
            if self.iterations is None:
                raise Missing(f"`{name}` is not printed")
            return float(TRAJECTORY[name](self.iterations, *arguments))
        if name == "reached":
            return float(self.field(self.thresholds, "method_seconds", KEYS_OF_THRESHOLDS,
                                    arguments) != "")
        if name in COLUMNS_OF_THRESHOLDS:
            field = self.field(self.thresholds, name, KEYS_OF_THRESHOLDS, arguments)
            # An empty field is not a gap: the method never reaches the threshold.
            field = field or NEVER.get(name, "")
        else:
            field = self.field(self.summary, name, ("mesh", "method", "degree"), arguments)
        try:
            return float(field)
        except ValueError:
            raise Missing(f"{name}({', '.join(arguments)}) has no number") from None

    @staticmethod
    def field(records, name, keys, arguments):
        """The field of the first record with these keys that has such a column."""
        for record in records:
            if name in record and all(record.get(k) == a for k, a in zip(keys, arguments)):
                return record[name]
        raise Missing(f"{name}({', '.join(arguments)}) is missing")


def trajectory(rows, column, mesh, method, degree):
    """(rows, numbers) of one method in the order of its iterations, without gaps."""
    rows = rows.select(mesh=mesh, method=method, degree=degree)
    values = rows.number(column)
    finite = np.isfinite(values)
    if not finite.any():
        raise Missing(f"{column} of {method} on {mesh}")
    return rows, np.where(finite, values, np.nan)


def at_start(rows, column, mesh, method, degree):
    """The number before the first iteration."""
    _, values = trajectory(rows, column, mesh, method, degree)
    return values[0]


def at_stage_end(rows, column, mesh, method, degree, stage):
    """The number at the last recorded iteration of a stage."""
    rows, values = trajectory(rows, column, mesh, method, degree)
    return last(values[rows.text("stage") == stage])


def after_iterations(rows, column, mesh, method, degree, n):
    """The number after the n-th iteration of the first stage, or after its last one."""
    rows, values = trajectory(rows, column, mesh, method, degree)
    require_all_iterations(rows)
    early = in_first_stage(rows) & (rows.number("iteration") <= float(n))
    return last(values[early])


def after_share_of_time(rows, column, mesh, method, degree, fraction):
    """The number when this fraction of the smoothing time is over, linear between iterations."""
    rows, values = trajectory(rows, column, mesh, method, degree)
    seconds = rows.number("smoothing_seconds")
    finite = np.isfinite(values)
    return np.interp(float(fraction) * seconds[-1], seconds[finite], values[finite])


def highest(rows, column, mesh, method, degree, stage=None):
    """The largest number over all iterations, or over those of a stage."""
    rows, values = trajectory(rows, column, mesh, method, degree)
    require_all_iterations(rows)
    values = values if stage is None else values[rows.text("stage") == stage]
    if not np.isfinite(values).any():
        raise Missing(f"{column} of {method} on {mesh}")
    return np.nanmax(values)


def total(rows, column, mesh, method, stage=None):
    """The sum over all iterations, or over those of a stage."""
    rows = of_one_degree(rows, mesh, method)
    values = rows.number(column)[rows.text("stage") != INITIAL if stage is None else rows.text("stage") == stage]
    if not len(values) or np.isnan(values).any():
        raise Missing(f"{column} of {method} on {mesh}")
    return values.sum()


def valid_iterations(rows, mesh, method):
    """The number of recorded iterations without invalid cells."""
    return np.count_nonzero(counts_of_invalid(rows, mesh, method) == 0)


def invalid_iterations(rows, mesh, method):
    """The number of recorded iterations with invalid cells."""
    return np.count_nonzero(counts_of_invalid(rows, mesh, method) > 0)


def of_one_degree(rows, mesh, method):
    """The rows of a method, those of its first degree: smoothing is the same for all."""
    rows = rows.select(mesh=mesh, method=method)
    degrees = rows.text("degree")
    rows = rows.select(degree=degrees[0]) if len(degrees) else rows
    require_all_iterations(rows)
    return rows


def first_row(rows, column, mesh, method, reached):
    """(rows, number of the first one whose value is `reached`), or None for the number."""
    rows = of_one_degree(rows, mesh, method)
    with np.errstate(invalid="ignore"):
        found = np.flatnonzero(reached(rows.number(column)))
    return rows, (int(found[0]) if len(found) else None)


def seconds_until(rows, column, mesh, method, value):
    """Smoothing time until the number is at least a value; infinite if it never is."""
    rows, first = first_row(rows, column, mesh, method, lambda numbers: numbers >= float(value))
    return np.inf if first is None else rows.number("smoothing_seconds")[first]


def seconds_until_below(rows, column, mesh, method, value):
    """Seconds until the number is at most a value."""
    rows, first = first_row(rows, column, mesh, method, lambda numbers: numbers <= float(value))
    return np.inf if first is None else rows.number("smoothing_seconds")[first]


def iterations_until(rows, column, mesh, method, value):
    """Iterations of the first stage until the number is at least a value; infinite if a later stage
    or none gets it there."""
    rows, first = first_row(rows, column, mesh, method, lambda numbers: numbers >= float(value))
    in_time = first is not None and (in_first_stage(rows)[first] or first == 0)
    return rows.number("iteration")[first] if in_time else np.inf


def seconds_per_iteration(rows, mesh, method):
    """Mean time of an iteration of the first stage."""
    rows = of_one_degree(rows, mesh, method)
    stage = in_first_stage(rows)
    start = rows.number("smoothing_seconds")[0]  # 0, except in results that count preparations as smoothing
    return (rows.number("smoothing_seconds")[stage][-1] - start) / rows.number("iteration")[stage][-1]


def counts_of_invalid(rows, mesh, method):
    """Invalid cells after each recorded iteration, without the mesh before smoothing."""
    rows = of_one_degree(rows, mesh, method)
    return rows.number("n_invalid")[rows.text("stage") != INITIAL]


def in_first_stage(rows):
    """A mask of the rows that belong to the first stage of smoothing."""
    stages = rows.text("stage")
    return stages == next((stage for stage in stages if stage != INITIAL), "")


def require_all_iterations(rows):
    """Raises Missing if there are no iterations, or if not each one of the first stage is recorded:
    the iterations in between are unknown then. (Later stages may count many steps per row.)"""
    numbers = rows.number("iteration")[in_first_stage(rows)]
    if not len(numbers) or numbers[0] > 1 or (np.diff(numbers) > 1).any():
        raise Missing("a record of every iteration")


def last(values):
    """The last of some numbers."""
    if not len(values):
        raise Missing("an iteration of this stage")
    return values[-1]


TRAJECTORY = {function.__name__: function for function in (
    at_start, at_stage_end, after_iterations, after_share_of_time, highest, total, valid_iterations,
    invalid_iterations, seconds_until, seconds_until_below, iterations_until,
    seconds_per_iteration)}
