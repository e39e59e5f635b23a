# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of a collection."""

import math

from ..collections.comparison import INITIAL_MESH, NEXT_DEGREE, SPLIT, payoffs, ranking
from ..collections.findings import findings_as_markdown
from ..collections.prediction import predictions, thresholds, thresholds_of_families
from ..collections.problems import problems_of
from ..results.rows import groups_of
from ..results.symbols import symbol_of
from .columns import between, number, table_of
from .gains import gains_table
from .table import number_cell, text_cell

INTERVALS = ("Intervals hold 95 % of bootstrap samples that draw families, or meshes where there are fewer than five "
             "families. A dash marks a missing number.")


def make_collection_tables(results):
    """(tables, page of findings): members, correlations, thresholds, ranks, whether smoothing pays, and what knowing the
    solution gains; tables without rows are left out."""
    problems = problems_of(results)
    predicted, enough = predictions(results), thresholds(results)
    ranks, gains = ranking(problems, results.methods), payoffs(problems, results.methods)
    tables = (members_table(results), prediction_table(results, predicted), threshold_table(results, enough),
              ranking_table(results, ranks), payoff_table(results, gains), gains_table(results))
    return ([table for table in tables if table.keys],
            findings_as_markdown(results, problems, predicted, enough, thresholds_of_families(results), ranks))


def members_table(results):
    """Counts the complete members of each family."""
    families = groups_of(results.members, "family")
    counts = [(len(rows), len(rows.select(status="complete")), len(rows.select(status="failed")))
              for _, rows in families]
    return table_of(
        results, "table_members", "members by family",
        [("Family", [text_cell(key[0]) for key, _ in families])],
        [(heading, [("", [number_cell(str(count[i])) for count in counts])])
         for i, heading in enumerate(("Members", "Complete", "Failed"))],
        ["members.csv has the reasons of failed members."])


def prediction_table(results, found):
    """Spearman's rank correlations."""
    return table_of(
        results, "table_prediction", "rank correlation of quality and outcome",
        [("Elements", [text_cell(p.elements) for p in found]), ("d", [number_cell(p.degree) for p in found]),
         ("Outcome", [text_cell(symbol_of(p.outcome).text) for p in found]),
         ("Quality", [text_cell(symbol_of(p.quality).text) for p in found])],
        [("Across members", [("", [number(p.across) for p in found]),
                             ("interval", [between(p.across_interval) for p in found])]),
         ("Within a member", [("median", [number(p.within) for p in found]),
                              ("interval", [between(p.within_interval) for p in found])]),
         ("Records", [("", [number_cell(str(p.n_records)) for p in found])]),
         ("Members", [("", [number_cell(str(p.n_members)) for p in found])])],
        ["Spearman's rank correlation over the recorded meshes without invalid cells. Across members, each outcome is divided by "
         "the smallest outcome of the same member. The meshes of a member differ only in the positions of their nodes. -1: higher "
         "quality always goes with a lower outcome.", INTERVALS])


def threshold_table(results, found):
    """Thresholds of a good quality."""
    return table_of(
        results, "table_good_enough", "quality beyond which the H1 error falls by less than 5 %",
        [("Elements", [text_cell(elements) for elements, *_ in found]),
         ("d", [number_cell(degree) for _, degree, *_ in found]),
         ("Quality", [text_cell(symbol_of(quality).text) for _, _, quality, _, _ in found])],
        [("From", [("", [number(value, ".3f") for *_, value, _ in found]),
                   ("interval", [between(low_high, ".3f") for *_, low_high in found])])],
        ["By the decreasing function of quality that is nearest to the logarithm of the relative error. The relative error is "
         "the error over the smallest error of the same member. All families together; findings.md has their own numbers.", INTERVALS])


def ranking_table(results, found):
    """The methods at equal budgets."""
    return table_of(
        results, "table_ranking", "methods at equal budgets of time",
        [("Method", [text_cell(results.title(entry.method)) for entry in found])],
        [("Mean rank", [("", [number(entry.rank) for entry in found]),
                        ("interval", [between(entry.rank_interval) for entry in found])]),
         ("Error / initial", [("", [number(entry.ratio, ".3f") for entry in found]),
                              ("interval", [between(entry.ratio_interval, ".3f") for entry in found])]),
         ("p", [("", [number(entry.p_value, ".2g") for entry in found])])],
        ["True H1 error over all members and degrees at equal time. This time is the median total time of the methods for the same "
         "mesh. Error / initial is a geometric mean; it is 1 for a method that ends with invalid cells. p: p-value of a paired "
         "test of logarithms by sign flips against the first method. The test swaps together what the intervals draw together.", INTERVALS])


def way_of(results, p):
    """The alternative to solving on the unsmoothed mesh."""
    besides = {NEXT_DEGREE: ", degree d + 1", SPLIT: ", cells split"}.get(p.change, "")
    return ("unsmoothed" if p.method == INITIAL_MESH else results.title(p.method)) + besides


def payoff_table(results, found):
    """Does smoothing pay?"""
    no_times = [] if any(math.isfinite(p.at_equal_time) for p in found) else [
        "Error / unsmoothed at equal time needs solutions with split cells: `set refined degrees = 1` in the study, for example."]
    return table_of(
        results, "table_payoff", "does smoothing pay?",
        [("Family", [text_cell(p.family) for p in found]), ("d", [number_cell(p.degree) for p in found]),
         ("Instead", [text_cell(way_of(results, p)) for p in found])],
        [("Error / initial", [("", [number(p.error, ".3f") for p in found]),
                              ("interval", [between(p.error_interval, ".3f") for p in found])]),
         ("Time / initial", [("", [number(p.time, ".3g") for p in found])]),
         ("Error / unsmoothed at equal time", [("", [number(p.at_equal_time, ".3f") for p in found]),
                                               ("interval", [between(p.at_equal_time_interval, ".3f") for p in found])]),
         ("Problems", [("", [number_cell(str(p.n_problems)) for p in found])])],
        ["Geometric means over a family's problems, relative to the unsmoothed mesh at degree d: true H1 error, and total time. The "
         "time is that of smoothing with its preparations, of assembly, and of the fastest solver of the run. Solvers are CG alone, "
         "with the diagonal, or with multigrid and its setup. Cells split: into 4, in space into 8. At equal time: median of the "
         "error over that of the unsmoothed mesh after the same total time. Errors of the unsmoothed mesh follow the power law "
         "through its error and the error with split cells. Below 1 smoothing pays. Problems that a method leaves with invalid "
         "cells are not counted: rows with different numbers of problems cannot be compared, the sentences of findings.md can.",
         *no_times,
         "Intervals hold 95 % of bootstrap samples that draw meshes. A dash marks a missing number."])
