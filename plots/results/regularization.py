# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a results folder of a regularization study."""

from dataclasses import dataclass
from pathlib import Path

from .rows import Rows, is_built_in, read_provenance, read_rows

STUDY = "regularization"  # the program's own of this kind
COUNTS = ("element", "transformation", "start", "sigma", "n_elements", "n_regularized", "mean",
          "deviation", "least", "most")


@dataclass(frozen=True)
class RegularizationResults:
    """One results folder."""

    folder: Path
    study: str
    study_title: str
    is_thesis_study: bool  # whether the thesis' numbers are about it
    counts: Rows
    validity: Rows


def read_regularization_results(folder):
    """Reads the folder; raises ResultsError if a file is missing, truncated or lacks a column."""
    folder = Path(folder)
    provenance = read_provenance(folder / "provenance.json")
    study = str(provenance.get("study") or folder.resolve().name)
    return RegularizationResults(
        folder, study, str(provenance.get("study_title") or study),
        is_built_in(provenance) and study == STUDY, read_rows(folder / "regularization.csv", COUNTS),
        read_rows(folder / "validity.csv", ("element", "n_elements", "n_valid", "share")))


def whole(rows):
    """The rows of those sigmas that made all elements regular."""
    complete = rows.text("n_regularized") == rows.text("n_elements")
    return rows.where(complete)
