# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of studies with methods that move nodes by the solution: the true error against the number of
solves, and against a mesh with shorter edges in time.

A method pays on a mesh if its resulting mesh has no larger true H1 error than the reference method's
on the refined mesh, in no more time: smoothing, the method's own solves and the last solution counted
for both.
"""

import math

import numpy as np

from ..collections.comparison import error_in_time
from ..results.rows import entries, solving_seconds
from ..results.symbols import SYMBOLS, Heading
from .alternatives import alternatives_table
from .descriptions import KEY_HEADINGS
from .number_format import MISSING, formatted
from .solving_methods import (DOES_NOT_PAY, ERRORS, PAYS, REFINED, key_cells, reference_method, smoothing_seconds,
                              solving_groups)
from .table import Group, Table, number_cell, text_cell

SOLVES = (5, 10, 20)
START = "start"  # the stage whose mesh all stages after it are compared with
SIZES = ("", REFINED, "-finer")  # of three of them, from whose errors orders are taken
NEVER = "never"


def make_energy_tables(results):
    """All tables that have rows."""
    tables = [factor_table(results), alternatives_table(results), pays_table(results), many_table(results),
              orders_table(results)]
    return [table for table in tables if table is not None]


def row_at(rows, n_solves):
    """The number of the first row with so many solves, or of the last one of a method that has stopped before; None
    without rows."""
    solves = {k: n for k, n in enumerate(rows.number("n_solves")) if rows.text("stage")[k] != START}
    if solves and max(solves.values()) < n_solves:
        return max(solves)
    return next((k for k, n in solves.items() if n == n_solves), None)


def factors(rows, column):
    """By which factor the error of the start's mesh is larger than that after each number of solves."""
    error, stages = rows.number(column), rows.text("stage")
    start = error[list(stages).index(START)] if START in stages else math.nan
    at = [row_at(rows, n) for n in SOLVES]
    return [math.nan if k is None or not error[k] > 0 else start / error[k] for k in at]


def factor_table(results):
    """Factors by which true errors fall below those of the mesh the methods begin with."""
    groups = solving_groups(results)
    if not groups:
        return None
    columns = []
    for name, column in ERRORS:
        cells = tuple(tuple(number_cell(text) for text in formatted(factors(rows, column), ".2f"))
                      for _, rows in groups)
        columns.append(Group(Heading(f"{name} after solves", f"{name} after solves"),
                             tuple(str(n) for n in SOLVES), cells))
    for name in ("q_mean", "q_min"):
        values = [results.summary.select(mesh=mesh, degree=degree, method=method).number(name)[0]
                  for (mesh, degree, method), _ in groups]
        columns.append(Group(SYMBOLS[name], ("",),
                             tuple((number_cell(text),) for text in formatted(values, ".3f"))))
    cells, rules = key_cells([key for key, _ in groups], results)
    return Table(study=results.study, name="table_energy", keys=cells, rules=rules, groups=tuple(columns),
                 caption=f"{results.study_title}: factors by which true errors fall",
                 key_headings=tuple(KEY_HEADINGS[key] for key in ("mesh", "degree", "method")),
                 left_aligned=(),
                 notes=(("", "Factors: true error on the mesh after the method's first stage over the true error after this total "
                             "number of solves. If the method stops earlier, its last mesh counts. Below 1 the error has risen. "
                             "The degree is that of the elements whose errors are measured; the method may use another degree. "
                             "Qualities are those of the resulting mesh. The resulting mesh has the least energy or estimate and "
                             "need not be the mesh after the last solve. The number of solves does not measure time; see "
                             "table_energy_alternatives for times."),))


def pays_table(results):
    """Compares errors and times with those of the refined mesh; says whether the method pays."""
    reference = reference_method(results)
    rows = [(key, compared(results, key, reference)) for key, _ in solving_groups(results)]
    rows = [(key, both) for key, both in rows if both is not None]
    if not rows:
        return None
    here, refined = [both[0] for _, both in rows], [both[1] for _, both in rows]
    against = zip(formatted([at_equal_time(*three) for _, three in rows], ".2f"),
                  formatted([equal_refinement(*three) for _, three in rows], ".1f"),
                  [text.replace("inf", NEVER) for text in formatted([solves_to_pay(*three) for _, three in rows], ".0f")])

    def group(heading, name, specification):
        texts = zip(formatted([each[name] for each in here], specification),
                    formatted([each[name] for each in refined], specification))
        return numbers(heading, ("here", "refined"), texts)
    verdicts = tuple((text_cell(verdict(*both[:2])),) for _, both in rows)
    cells, rules = key_cells([key for key, _ in rows], results)
    return Table(study=results.study, name="table_energy_pays", keys=cells, rules=rules,
                 groups=(group("H1 error", "error", ".3e"), group("Seconds", "seconds", ".3f"),
                         numbers("Against refinement", ("at equal time", "unknowns", "solves until it pays"), against),
                         Group(Heading("", ""), ("Verdict",), verdicts)),
                 caption=f"{results.study_title}: against {results.title(reference)} on the refined mesh",
                 key_headings=tuple(KEY_HEADINGS[key] for key in ("mesh", "degree", "method")),
                 left_aligned=("Verdict",),
                 notes=(("", "Seconds: smoothing, with its preparation and the method's own solves, and the solution on the "
                             "resulting mesh. The solution has the assembly, if the results have it, and the fastest solver of "
                             "the run. A method pays if neither its error nor its time is larger than on the refined mesh. At "
                             "equal time: error of the method over that of refinement after the same time. Below 1 the method "
                             "uses the time better. Errors of refinement follow the power law through both meshes of "
                             f"{results.title(reference)}, if its time grows with the mesh. Unknowns: how many times as many "
                             "unknowns that law needs for the method's error. Solves until it pays: number of solutions on one "
                             "mesh, for example time steps, from which on the method takes less time than that many unknowns. "
                             "Their times follow power laws, too."),))


def many_table(results):
    """Compares meshes that are made for several solutions with the refined mesh of the same errors: mean errors and
    total times."""
    reference = reference_method(results)
    rows = [(key, compared_for_all(results, key, reference)) for key, _ in solving_groups(results)]
    rows = [(key, three) for key, three in rows if three is not None]
    if not rows or not len(results.solutions):
        return None
    same = [refinement_with_same_error(*three) for _, three in rows]
    here = [three[0] for _, three in rows]
    refined = [once + each for once, each in same]

    def one_column(heading, texts):
        return Group(Heading(heading, heading), ("",), tuple((number_cell(text),) for text in texts))
    errors = zip(formatted([three[0]["error"] for _, three in rows], ".3f"),
                 formatted([error_of_others(results, key, reference) for key, _ in rows], ".3f"),
                 formatted([three[1]["error"] for _, three in rows], ".3f"))
    seconds = zip(formatted([each["smoothing"] for each in here], ".3f"),
                  formatted([each["solution"] for each in here], ".3f"), formatted(refined, ".3f"))
    verdicts = tuple((text_cell(verdict_of(each["seconds"], others)),) for each, others in zip(here, refined))
    until = [text.replace("inf", NEVER) for text in formatted([solves_to_pay(*three) for _, three in rows], ".0f")]
    cells, rules = key_cells([key for key, _ in rows], results)
    title = results.title(reference)
    return Table(study=results.study, name="table_energy_many", keys=cells, rules=rules,
                 groups=(one_column("n", [str(len(solutions_for(results, key[2]))) for key, _ in rows]),
                         numbers(f"H1 error over {title}'s", ("here", "of the others", "refined"), errors),
                         numbers("Seconds", ("smoothing", "n solutions", "refined"), seconds),
                         one_column("Times until it pays", until),
                         Group(Heading("", ""), ("Verdict",), verdicts)),
                 caption=f"{results.study_title}: one mesh for n solutions",
                 key_headings=tuple(KEY_HEADINGS[key] for key in ("mesh", "degree", "method")),
                 left_aligned=("Verdict",),
                 notes=(("", "n: number of solutions that the mesh is made for. Errors: true H1 errors over those on the mesh of "
                             f"{title}, as the geometric mean over the n solutions. Of the others: the same over the solutions "
                             f"that the mesh is not made for. Refined: the finer mesh of {title}. Seconds: time of smoothing with "
                             "the method's own solves; time of the n solutions on its mesh, each with its own assembly; and total "
                             "time on a refined mesh with the mean error of the method. The latter follows the power laws through "
                             f"both meshes of {title}. A method pays if it takes no more time than that. Times until it pays: how "
                             "often all n solutions have to be computed on the mesh, for example in time steps, until the method "
                             "pays."),))


def orders_table(results):
    """With which power of the edge length the errors fall: fitted to three sizes of a domain's mesh."""
    families = [mesh for mesh in results.meshes if all(mesh + size in results.meshes for size in SIZES)]
    keys = [(mesh, degree, method) for mesh in families for degree in results.degrees for method in results.methods]
    if not keys or not solving_groups(results):
        return None
    lengths = {mesh["name"]: mesh["n_cells"] ** (-1 / mesh["dimension"]) for mesh in results.provenance["meshes"]}
    values = [orders(results, key, lengths) for key in keys]
    cells, rules = key_cells(keys, results)
    groups = tuple(Group(Heading(f"Order of {name}", f"Order of {name}"), ("",),
                         tuple((number_cell(text),) for text in formatted([each[k] for each in values], ".2f")))
                   for k, (name, _) in enumerate(ERRORS))
    return Table(study=results.study, name="table_energy_orders", keys=cells, rules=rules, groups=groups,
                 caption=f"{results.study_title}: orders of the errors in the edge length",
                 key_headings=tuple(KEY_HEADINGS[key] for key in ("mesh", "degree", "method")), left_aligned=(),
                 notes=(("", "Slopes of the straight line, by least squares, through the logarithms of true errors of the "
                             f"resulting meshes of {len(SIZES)} sizes over those of an edge length that is the number of "
                             "cells to the power of minus one over the dimension."),))


def orders(results, key, lengths):
    """Orders of the H1 and the L2 error; NaN where an error is missing at one of the sizes. lengths: of the edges, by
    mesh."""
    mesh, degree, method = key
    rows = [results.summary.select(mesh=mesh + size, degree=degree, method=method) for size in SIZES]
    if not all(len(each) for each in rows):
        return [math.nan] * len(ERRORS)
    logarithms = [math.log(lengths[mesh + size]) for size in SIZES]
    return [np.polyfit(logarithms, [np.log(each.number(column)[0]) for each in rows], 1)[0] for _, column in ERRORS]


def numbers(heading, headings, texts):
    """A group of columns of numbers; texts: of each row."""
    return Group(Heading(heading, heading), headings, tuple(tuple(map(number_cell, row)) for row in texts))


def compared(results, key, reference):
    """Returns (here, refined, unrefined): error, seconds of smoothing, of one solution and of both, and unknowns of the
    method's result and of the reference method's on the refined mesh and on this one; None without a refined mesh."""
    mesh, degree, method = key
    three = [results.summary.select(mesh=name, degree=degree, method=which)
             for name, which in ((mesh, method), (mesh + REFINED, reference), (mesh, reference))]
    if reference is None or not all(len(rows) for rows in three):
        return None
    smoothing = [smoothing_seconds(rows) for rows in three]
    solution = [solving_seconds(rows)[0] for rows in three]
    return tuple({"error": rows.number("h1_error")[0], "smoothing": once, "solution": each, "seconds": once + each,
                  "unknowns": rows.number("n_free")[0]} for rows, once, each in zip(three, smoothing, solution))


def solutions_for(results, method):
    """Labels of the solutions that the method's mesh is made for (default: the first of all)."""
    said = next((entry.get("smooth_for") for entry in entries(results.provenance, "methods")
                 if entry["name"] == method), None)
    return said or list(dict.fromkeys(results.solutions.text("solution")))[:1]


def compared_for_all(results, key, reference):
    """Like compared(), over the solutions that the method's mesh is made for: errors are geometric means over those of
    the reference method here, and a solution is all of them, one after the other."""
    mesh, degree, method = key
    three = compared(results, key, reference)
    if three is None:
        return None
    chosen = solutions_for(results, method)
    rows = [[results.solutions.select(mesh=name, degree=degree, method=which, solution=solution) for solution in chosen]
            for name, which in ((mesh, method), (mesh + REFINED, reference), (mesh, reference))]
    if not chosen or not all(len(each) for of_mesh in rows for each in of_mesh):
        return None
    logarithms = [np.mean([np.log(each.number("h1_error")[0]) for each in of_mesh]) for of_mesh in rows]
    seconds = [sum(solving_seconds(each)[0] for each in of_mesh) for of_mesh in rows]
    return tuple({**each, "error": math.exp(logarithm - logarithms[2]), "solution": all_of_them,
                  "seconds": each["smoothing"] + all_of_them}
                 for each, logarithm, all_of_them in zip(three, logarithms, seconds))


def error_of_others(results, key, reference):
    """The geometric mean of errors over the reference method's, of the solutions that the method's mesh is not made for;
    NaN where it is made for all."""
    mesh, degree, method = key
    others = [name for name in dict.fromkeys(results.solutions.text("solution"))
              if name not in solutions_for(results, method)]
    errors = [[results.solutions.select(mesh=mesh, degree=degree, method=which, solution=name).number("h1_error")
               for name in others] for which in (method, reference)]
    if not others or not all(len(each) for of_method in errors for each in of_method):
        return math.nan
    return math.exp(np.mean([np.log(own[0] / others[0]) for own, others in zip(*errors)]))


def at_equal_time(here, refined, unrefined):
    """The method's error over what refinement has after the same time; NaN unless that is better, and so much dearer that
    its time is one of its size: it grows at least as the root of the unknowns."""
    if not refined["seconds"] / unrefined["seconds"] >= math.sqrt(refined["unknowns"] / unrefined["unknowns"]):
        return math.nan
    law = error_in_time(unrefined["error"], unrefined["seconds"], refined["error"], refined["seconds"])
    return here["error"] / law(here["seconds"])


def equal_refinement(here, refined, unrefined):
    """By what the unknowns have to be multiplied until refinement has the method's error; NaN unless it lowers errors."""
    gain = unrefined["error"] / refined["error"]
    if not gain > 1.0:
        return math.nan
    return (unrefined["error"] / here["error"])**(math.log(refined["unknowns"] / unrefined["unknowns"]) / math.log(gain))


def refinement_with_same_error(here, refined, unrefined):
    """Seconds of smoothing and of solving once on the refined mesh that has the method's error; NaN unless refinement
    lowers errors, or where times are not known."""
    gain = unrefined["error"] / refined["error"]
    if not (gain > 1.0 and unrefined["smoothing"] > 0.0 and unrefined["solution"] > 0.0):
        return math.nan, math.nan
    size = math.log(unrefined["error"] / here["error"]) / math.log(gain)
    return tuple(unrefined[what] * (refined[what] / unrefined[what])**size for what in ("smoothing", "solution"))


def solves_to_pay(here, refined, unrefined):
    """The number of solutions on one mesh from which on the method is cheaper than refinement with its error. Infinite
    if a solution on the refined mesh takes no longer. NaN unless refinement lowers errors, or if times are not
    known."""
    once, each = refinement_with_same_error(here, refined, unrefined)
    more_once, less_each = here["smoothing"] - once, each - here["solution"]
    if math.isnan(more_once) or math.isnan(less_each):
        return math.nan
    if more_once <= less_each:
        return 1
    return math.ceil(more_once / less_each) if less_each > 0.0 else math.inf


def verdict(here, refined):
    """The verdict in words."""
    if any(math.isnan(value) for each in (here, refined) for value in each.values()):
        return MISSING
    pays = here["error"] <= refined["error"] and here["seconds"] <= refined["seconds"]
    return PAYS if pays else DOES_NOT_PAY


def verdict_of(seconds, others):
    """The verdict at equal errors, by total seconds."""
    if math.isnan(seconds) or math.isnan(others):
        return MISSING
    return PAYS if seconds <= others else DOES_NOT_PAY
