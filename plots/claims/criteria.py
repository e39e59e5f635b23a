# SPDX-License-Identifier: GPL-3.0-or-later
"""Dates on which the criterion of each claim was written: studies/thesis/criteria.csv."""

from dataclasses import dataclass

from ..results.data_folder import thesis_folder
from ..results.rows import ResultsError, read_rows

COLUMNS = ("id", "written", "changed", "commit", "results_known")
YES = "yes"


@dataclass(frozen=True)
class Criterion:
    """A line of the file. Dates are, for example, 2026-11-21; `changed` is empty for an unchanged criterion."""

    written: str
    changed: str
    commit: str  # commit with the present words of the criterion
    results_known: bool  # True if results of smoothfem were known when it was written

    @property
    def is_as_it_should_be(self):
        """True if it was written before the results were known, and not changed afterwards."""
        return not self.changed and not self.results_known

    def __str__(self):
        return ", ".join((f"written {self.written}", *([f"changed {self.changed}"] if self.changed else []),
                          *(["our results were known"] if self.results_known else [])))


def read_criteria():
    """Returns {name of the claim: Criterion}."""
    rows = read_rows(thesis_folder() / "criteria.csv", COLUMNS).records()
    found = {row["id"]: Criterion(row["written"], row["changed"], row["commit"], row["results_known"] == YES)
             for row in rows}
    if len(found) < len(rows):
        raise ResultsError(f"{thesis_folder() / 'criteria.csv'}: a claim has two lines.")
    return found
