# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of a collection."""

import math

from ..collections.comparison import INITIAL_MESH, NEXT_DEGREE, SPLIT, at_budgets, gains, gains_by_number, payoffs
from ..collections.findings import findings_as_markdown
from ..collections.orders import ERRORS, LEAST_CHANGE, errors_of, orders
from ..collections.prediction import RECORDS_OF_CURVE, predictions
from ..collections.problems import ERROR, problems_by, problems_of
from ..results.rows import SOLVING, groups_of
from ..results.symbols import of_solver, symbol_of
from .columns import between, number, table_of
from .gains import gains_table
from .pairs import pairs_table
from .table import number_cell, text_cell

INTERVALS = ("Means are over families, each counted once; numbers that contain a time are medians in each family; intervals are 95 % intervals of these means, by Student's t distribution over "
             "families. A dash marks a missing number.")
LEVELS = "Level: mean quality that the initial mesh was distorted to."


def make_collection_tables(results):
    """(tables, page of findings): members, gains, budgets, whether smoothing pays, orders, correlations, what knowing the solution
    gains, and gains by numbers of further solvers; tables without rows are left out."""
    problems, predicted = problems_of(results), predictions(results)
    found, budgets = gains(problems, results.methods), at_budgets(problems, results.methods)
    # The reference method, and methods that move nodes by the solution.
    paying = [method for method in results.methods if method == results.methods[0] or method in results.solving]
    alternatives = payoffs(problems, paying)
    of_solvers = {solver: gains_by_number(results, solver) for solver in results.solvers}
    tables = (members_table(results), smoothing_table(results, found), budget_table(results, {ERROR: budgets}),
              payoff_table(results, alternatives), orders_table(results, orders(results)), prediction_table(results, predicted),
              gains_table(results), pairs_table(results),
              *(solver_table(results, solver, by_number) for solver, by_number in of_solvers.items()),
              *(budget_table(results, budgets_by_error(results, solver), solver) for solver in results.solvers),
              *(orders_table(results, orders(results, solver), solver) for solver in results.solvers))
    return ([table for table in tables if table.keys],
            findings_as_markdown(results, problems, found, budgets, alternatives, predicted, orders(results),
                                 of_solvers.values()))


def kind_columns(found):
    """The columns that name the kind of meshes."""
    return [("Elements", [text_cell(entry.elements) for entry in found]), ("d", [number_cell(entry.degree) for entry in found]),
            ("Level", [text_cell(entry.level) for entry in found])]


def percent(share):
    """A share as the cell of a percentage."""
    return number(100.0 * share, ".0f")


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


def gain_columns(reference, found, what, higher):
    """The columns of gains in a number; higher: the heading of the share of problems where it rises."""
    return [(f"{what} / initial", [("", [number(gain.ratio, ".3f") for gain in found]),
                                   ("interval", [between(gain.interval, ".3f") for gain in found])]),
            (f"{what} / {reference}", [("", [number(gain.over_reference, ".3f") for gain in found]),
                                       ("interval", [between(gain.over_reference_interval, ".3f") for gain in found]),
                                       ("p", [number(gain.p_value, ".2g") for gain in found])]),
            ("Time", [("", [number(gain.seconds, ".2g") for gain in found])]),
            (f"{higher} (%)", [("", [percent(gain.worse) for gain in found])]),
            ("Failed (%)", [("", [percent(gain.failed) for gain in found])]),
            ("Problems", [("", [number_cell(str(gain.n_problems)) for gain in found])]),
            ("Families", [("", [number_cell(str(gain.n_families)) for gain in found])])]


def solver_table(results, solver, by_number):
    """What each method does to the numbers of a further solver."""
    names, found = zip(*((name, gain) for name, of_number in by_number.items() for gain in of_number)) if by_number else ((), ())
    reference = results.title(results.methods[0]) if results.methods else ""
    return table_of(
        results, f"table_solver_{solver.label}", f"what smoothing does to the numbers of {solver.title}",
        [("Number", [text_cell(symbol_of(of_solver(name)[1]).text) for name in names]), *kind_columns(found),
         ("Method", [text_cell(results.title(gain.method)) for gain in found])],
        gain_columns(reference, found, "Number", "Higher"),
        ["Numbers after over before smoothing, geometric means. Failed: no number, or a mesh with invalid cells; the initial mesh is then "
         "used, ratio 1. Higher: the number rises by more than 1 %. Time: of smoothing, over one solution of this solver on the initial "
         "mesh, without assembly; a dash: the solver records no times of CG. p: as in table_smoothing, for each number by itself. Numbers "
         "that smoothing does not change, and those with values of 0 or below, are left out.", LEVELS, INTERVALS])


def smoothing_table(results, found):
    """What each method does to the error."""
    reference = results.title(results.methods[0]) if results.methods else ""
    return table_of(
        results, "table_smoothing", "what smoothing does to the error",
        [*kind_columns(found), ("Method", [text_cell(results.title(gain.method)) for gain in found])],
        gain_columns(reference, found, "Error", "Worse"),
        ["True H1 error after over that before smoothing, geometric means. Failed: no result, or one with invalid cells; the initial mesh is "
         "then used, ratio 1. Worse: the error rises by more than 1 %. Time: of smoothing, over one solution on the initial mesh by the "
         f"fastest solver of the run. p: sign flips of the families' mean logarithms against {reference}, the first method of the study; "
         "adjusted for all methods of these meshes (Holm).", LEVELS, INTERVALS])


def budgets_by_error(results, solver):
    """Column -> gains within budgets, of the errors of a solver that records times."""
    if not any(f"{solver.label}.{name}" in solver.columns for name in SOLVING):
        return {}
    return {name: at_budgets(problems_by(results, solver, name), results.methods) for name in errors_of(solver)}


def budget_table(results, by_error, solver=None):
    """What each method reaches in a given time. by_error: column -> gains within budgets. solver: None is Poisson's."""
    by_key = {(name, entry.elements, entry.degree, entry.level, entry.method, entry.budget): entry
              for name, found in by_error.items() for entry in found}
    rows, budgets = list(dict.fromkeys(key[:-1] for key in by_key)), sorted({key[-1] for key in by_key})
    first = [by_key[(*row, budgets[0])] for row in rows]
    errors = [("Error", [text_cell(symbol_of(of_solver(row[0])[1]).text) for row in rows])] if solver else []
    return table_of(
        results, f"table_budgets_{solver.label}" if solver else "table_budgets",
        f"errors of {solver.title} after equal smoothing times" if solver else "error after equal smoothing times",
        [*errors, *kind_columns(first), ("Method", [text_cell(results.title(entry.method)) for entry in first])],
        [(f"{budget:g} solutions", [("", [number(by_key[(*row, budget)].ratio, ".3f") for row in rows]),
                                    ("interval", [between(by_key[(*row, budget)].interval, ".3f") for row in rows])])
         for budget in budgets],
        [("Error" if solver else "True H1 error") + " over that of the initial mesh, geometric means. A budget is a multiple of the time of one solution on the initial "
         "mesh. The mesh is the last one that was recorded within the budget; after a method's end it is its result. Without a valid "
         "mesh the ratio is 1.", LEVELS, INTERVALS])


def prediction_table(results, found):
    """Spearman's rank correlations."""
    return table_of(
        results, "table_prediction", "rank correlation of quality and outcome",
        [("Elements", [text_cell(p.elements) for p in found]), ("d", [number_cell(p.degree) for p in found]),
         ("Outcome", [text_cell(symbol_of(p.outcome).text) for p in found]),
         ("Quality", [text_cell(symbol_of(p.quality).text) for p in found])],
        [("Correlation", [("", [number(p.mean) for p in found]), ("interval", [between(p.interval) for p in found])]),
         ("Meshes", [("", [number_cell(str(p.n_records)) for p in found])]),
         ("Families", [("", [number_cell(str(len(p.by_family))) for p in found])])],
        [f"Mean over families of Spearman's rank correlation over a family's meshes without invalid cells: up to {RECORDS_OF_CURVE} of each "
         "method on each member. Outcomes are divided by the smallest one of the same member. -1: higher quality always goes with a "
         "lower outcome.", INTERVALS])


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
        [*kind_columns(found), ("Instead", [text_cell(way_of(results, p)) for p in found])],
        [("Error / initial", [("", [number(p.error, ".3f") for p in found]),
                              ("interval", [between(p.error_interval, ".3f") for p in found])]),
         ("Time / initial", [("", [number(p.time, ".3g") for p in found]),
                             ("interval", [between(p.time_interval, ".3g") for p in found])]),
         ("Error / unsmoothed at equal time", [("", [number(p.at_equal_time, ".3f") for p in found]),
                                               ("interval", [between(p.at_equal_time_interval, ".3f") for p in found])]),
         ("Problems", [("", [number_cell(str(p.n_problems)) for p in found])])],
        ["Geometric means relative to the unsmoothed mesh at degree d: true H1 error, and total time. The time is that of smoothing with its "
         "preparation, of assembly, and of the fastest solver of the run. Solvers are CG alone, with the diagonal, or with multigrid and "
         "its setup. Cells split: into 4, in space into 8. At equal time: the error over that of the unsmoothed mesh after the same "
         "total time. Errors of the unsmoothed mesh follow the power law through its error and the error with split cells. Below 1 "
         "smoothing pays. Where the method has no valid result, the initial mesh is solved after all.", *no_times, LEVELS, INTERVALS])


def orders_table(results, found, solver=None):
    """With which power of h the errors fall, before and after smoothing. One row for all errors. solver: None is Poisson's."""
    rows = {}
    for entry in found:
        rows.setdefault((*entry.mesh, entry.method), {})[entry.error] = entry
    first = [next(iter(of_row.values())) for of_row in rows.values()]
    names = ERRORS if solver is None else {error: symbol_of(of_solver(error)[1]).text for error in dict.fromkeys(e.error for e in found)}
    several = [(heading, [text_cell(getattr(entry, name) or "first") for entry in first])
               for heading, name in (("Algorithm", "algorithm"), ("Solution", "solution")) if len({getattr(entry, name) for entry in first}) > 1]
    return table_of(
        results, f"table_orders_{solver.label}" if solver else "table_orders",
        f"orders of the errors of {solver.title} in the mesh size" if solver else "orders of the errors in the mesh size",
        [*kind_columns(first), ("Family", [text_cell(entry.family) for entry in first]), *several,
         ("Method", [text_cell(results.title(entry.method)) for entry in first])],
        [group for error, name in names.items() for group in (
            (f"Order of {name}", [("", [number(of_row[error].order) for of_row in rows.values()]),
                                  ("interval", [between(of_row[error].interval) for of_row in rows.values()])]),
            (f"Change of {name}", [("", [number(of_row[error].change, "z.2f") for of_row in rows.values()]),
                                   ("interval", [between(of_row[error].change_interval, "z.2f") for of_row in rows.values()])]))]
        + [("Sizes", [("", [number_cell(str(entry.n_sizes)) for entry in first])])],
        ["Order: slope of the straight line, by least squares, through the logarithms of true errors and h. h: number of cells to the power of "
         "minus one over the dimension. Change: slope of the logarithm of error after over error before smoothing. Intervals: 95 %, by "
         f"Student's t distribution over the sizes; seeds of a size give one mean. A change below {LEAST_CHANGE:g} counts as one of the "
         "constant. Sizes: with a result without invalid cells; a dash marks less than three.", LEVELS])
