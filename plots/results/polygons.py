# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a results folder of a polygon study: its CSV files, and polygons out of their rows."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .rows import Rows, is_built_in, read_provenance, read_rows

STUDY = "polygons"  # the program's own of this kind
# What tables and figures cannot do without.
REQUIRED_COLUMNS = {
    "theorems": ("theorem", "statement", "quantity", "cases", "measured", "expected",
                 "max_deviation", "tolerance", "holds"),
    "classification": ("n", "theta", "lambda", "predicted", "iterated", "agree"),
    "decomposition": ("n", "eigenpolygon", "node", "x", "y"),
    "domains": ("n", "line", "theta", "lambda", "domain", "convergence"),
    "limits": ("n", "theta", "domain", "steps", "node", "x", "y"),
    "sequences": ("transformation", "n", "theta", "lambda", "domain", "step", "node", "x", "y"),
    "side_ratios": ("transformation", "theta", "step", "defect", "bound"),
}


@dataclass(frozen=True)
class PolygonResults:
    """One results folder of a polygon study, file by file."""

    folder: Path
    study: str
    study_title: str
    is_thesis_study: bool  # whether its figures are those of the thesis, by their numbers
    theorems: Rows
    classification: Rows
    decomposition: Rows
    domains: Rows
    limits: Rows
    sequences: Rows
    side_ratios: Rows


def read_polygon_results(folder):
    """Reads the folder; raises ResultsError if a file is missing, truncated or lacks a column."""
    folder = Path(folder)
    files = {name: read_rows(folder / f"{name}.csv", columns)
             for name, columns in REQUIRED_COLUMNS.items()}
    provenance = read_provenance(folder / "provenance.json")
    study = str(provenance.get("study") or folder.resolve().name)
    return PolygonResults(folder=folder, study=study,
                          study_title=str(provenance.get("study_title") or study),
                          is_thesis_study=is_built_in(provenance) and study == STUDY, **files)


def nodes_of(rows):
    """The nodes of the one polygon in the rows, shape (n, 2)."""
    order = np.argsort(rows.number("node"))
    return np.column_stack([rows.number("x"), rows.number("y")])[order]
