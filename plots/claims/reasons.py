# SPDX-License-Identifier: GPL-3.0-or-later
"""Reasons why claims do not hold. A reason is tested by a study that changes the one thing, in studies/reasons,
and by the claim itself, judged on that study's results: they are in results/reference/reasons."""

from functools import lru_cache

from ..results.data_folder import data_folder
from ..results.printed_values import as_guess
from ..results.rows import ResultsError
from ..results.smoothing import read_results

REASONS = "reasons"  # the folder's name, in studies and in results/reference


def reference():
    """The folder of results folders that come with the program."""
    return data_folder() / "results" / "reference"


def sentence(test, judge):
    """What one test of a reason has shown. test: `study`, whose results are judged; `change`, what is other in it;
    `reason`, what is thought. judge: results -> Outcome of the claim."""
    folder = reference() / test["study"]
    if not (folder / "summary.csv").exists():
        return as_guess(test["reason"])
    outcome = judge(results_of(folder))
    holds, fails, unknown = ("the claim holds: that is the reason", "it does not hold either: that is not the reason",
                             "it cannot be judged")
    found = {"holds": holds, "does not hold": fails}.get(outcome.verdict, unknown)
    return f"Tested by `{test['study']}`, {test['change']}: {found} ({outcome.ours})."


@lru_cache(maxsize=None)
def results_of(folder):
    """The results of a study that tests reasons; several claims ask for one."""
    try:
        return read_results(folder)
    except ResultsError as error:
        raise ResultsError(f"{error} It tests a reason of a claim.") from None
