# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds results of studies that test why claims do not hold. Each of these studies changes one thing (studies/reasons), and
the claim is judged on its results."""

from functools import lru_cache

from ..results.data_folder import data_folder
from ..results.rows import is_there
from ..results.smoothing import read_results

REASONS = "reasons"  # the folder's name, in studies and in results/reference


def reference():
    """Returns the folder results/reference of the program."""
    return data_folder() / "results" / "reference"


def results_of_test(test):
    """The results of the study that tests a reason (an entry of a claim's `tests`); None if it was not run."""
    folder = reference() / test["study"]
    return results_of(folder) if is_there(folder / "summary.csv") else None


@lru_cache(maxsize=None)
def results_of(folder):
    """Calls read_results, cached, since several claims use one folder."""
    return read_results(folder)
