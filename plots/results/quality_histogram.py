# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the numbers of cells of a mesh by mean ratio."""

from dataclasses import dataclass
from pathlib import Path
from typing import Optional

import numpy as np

from .cell_types import ANY_CELL, CELL_NAMES
from .rows import ResultsError, groups_of, read_rows

COLUMNS = ("lower", "upper", "count")
TYPE = "cell_type"


@dataclass(frozen=True)
class QualityHistogram:
    """Numbers of cells by mean ratio and type of cell, and the data next to them."""

    title: str
    lower: np.ndarray  # (n_bins,) mean ratios at which the bins begin
    upper: np.ndarray  # (n_bins,) and end
    counts: dict  # name of a cell type -> (n_bins,) integers; at least one is positive
    q_min: Optional[float] = None
    q_mean: Optional[float] = None
    n_invalid: int = 0


def read_quality_histogram(path, title, q_min=None, q_mean=None, n_invalid=0):
    """Reads a CSV file with a row for each bin: `lower` and `upper` mean ratio, `count` of the cells in
    between. Where there is a column `cell_type` (triangle, ..., pyramid), a bin has a row for each of the
    types. Raises ResultsError if these are no bins and counts."""
    if not Path(path).exists():
        raise ResultsError(f"{path}: the file is missing.")
    rows = read_rows(path, COLUMNS, ends_with_line=False)
    lower, upper, count = (rows.number(name) for name in COLUMNS)
    refuse_unless(np.isfinite([lower, upper, count]).all(), rows, "holds an empty or infinite number")
    refuse_unless((lower < upper).all(), rows, "has a bin whose `upper` is not above its `lower`")
    refuse_unless((count == np.round(count)).all() and (count >= 0).all(), rows,
                  "has a `count` that is not a number of cells")
    refuse_unless(count.any(), rows, "counts no cell")
    bins = np.unique(np.column_stack([lower, upper]), axis=0)
    refuse_unless((bins[1:, 0] >= bins[:-1, 1]).all(), rows, "has bins that overlap")
    counts = {}
    for (name,), chosen in groups_of(rows, TYPE):
        refuse_unless(name in ("", *CELL_NAMES), rows,
                      f"has the unknown cell type `{name}`; known are {', '.join(CELL_NAMES)}")
        at = np.searchsorted(bins[:, 0], chosen.number("lower"))
        refuse_unless(len(set(at)) == len(at), rows, "has a bin twice")
        counts[name or ANY_CELL] = np.zeros(len(bins), dtype=np.int64)
        counts[name or ANY_CELL][at] = chosen.number("count")
    return QualityHistogram(title, *bins.T, counts, q_min, q_mean, n_invalid)


def refuse_unless(condition, rows, what):
    """Raises ResultsError with the fault of a file."""
    if not condition:
        raise ResultsError(f"{rows.path}: the file {what}.")
