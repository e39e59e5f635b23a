# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares solution-adaptive methods with alternatives: the next degree, every cell split, or a finer mesh. Each alternative
uses the unsmoothed mesh or the mesh of the first method that does not solve.

A method pays on a mesh if none of these has an error as small in no more time: smoothing, the method's own solves and the
last solution counted for all. This rule was written on 26 November 2026, when results were known. The verdict of
table_energy_pays compares with that method on the finer mesh only.
"""

import math
from dataclasses import dataclass

from ..results.rows import solving_seconds
from ..results.smoothing import INITIAL
from ..results.symbols import Heading
from .descriptions import KEY_HEADINGS
from .number_format import MISSING, formatted
from .solving_methods import (DOES_NOT_PAY, PAYS, REFINED, key_cells, reference_method, smoothing_seconds,
                              solving_groups)
from .table import Group, Table, number_cell, text_cell

ERROR = "h1_error"


@dataclass(frozen=True)
class Way:
    """An alternative way to a solution: its name, the true H1 error, and total seconds; NaN: not known."""

    title: str
    error: float
    seconds: float


def alternatives_table(results):
    """The table of the best alternative, in no more time, to each solution-adaptive method; None without
    alternatives."""
    reference = reference_method(results)
    rows = [(key, others, with_best_alternative(results, key, others)) for key, _ in solving_groups(results)
            for others in [ways_without(results, key[0], key[1], reference)] if len(others) > 0]
    if not rows:
        return None
    own_ways = [both[0] for _, _, both in rows]
    best = [both[1] for _, _, both in rows]
    solves = [method_solve_seconds(results, key) for key, _, _ in rows]
    gains = [way.error / here.error if way and here.error > 0 else math.nan for here, way in zip(own_ways, best)]

    def column(heading, texts):
        return Group(Heading(heading, heading), ("",), tuple((number_cell(text),) for text in texts))
    inside = [(text_cell(way.title if way else MISSING), number_cell(text))
              for way, text in zip(best, formatted([way.error if way else math.nan for way in best], ".3e"))]
    cells, rules = key_cells([key for key, _, _ in rows], results)
    return Table(study=results.study, name="table_energy_alternatives", keys=cells, rules=rules,
                 groups=(column("H1 error", formatted([way.error for way in own_ways], ".3e")),
                         column("Seconds", formatted([way.seconds for way in own_ways], ".3f")),
                         column("of which solves", formatted(solves, ".3f")),
                         Group(Heading("Best without, in no more time", "Best without, in no more time"),
                               ("way", "H1 error"), tuple(inside)),
                         column("Gain", formatted(gains, ".2f")),
                         Group(Heading("", ""), ("Verdict",),
                               tuple((text_cell(verdict(*both)),) for both in zip(own_ways, best)))),
                 caption=f"{results.study_title}: compared with the next degree, split cells and finer meshes",
                 key_headings=tuple(KEY_HEADINGS[key] for key in ("mesh", "degree", "method")),
                 left_aligned=("way", "Verdict"),
                 notes=(("", "H1 errors are true errors. Seconds are total times: smoothing, with its preparation and the method's "
                             "own solves (of which solves), and the solution on the resulting mesh. Best without: the alternative "
                             "with the smallest error in no more time than the method. Alternatives use the unsmoothed mesh or that "
                             f"of {results.title(reference)}. They are the mesh itself, the next degree (d), every cell split, and "
                             "the finer mesh, if the study has them. No mesh is refined twice. For methods that take much longer "
                             "than split cells, this would be a better alternative. Gain: the error of the alternative over that "
                             "of the method. A method pays if no alternative has an error as small. "
                             "This verdict was written on 2026-11-26, when results were known."),))


def ways_without(results, mesh, degree, reference):
    """The ways that the study has results of; none if all it has is the meshes as they are."""
    as_they_are, others = [], []
    for method in (INITIAL, reference):
        if method is None:
            continue
        title, higher = results.title(method), str(int(degree) + 1)
        here = results.summary.select(mesh=mesh, method=method)
        as_they_are += way(title, here.select(degree=degree), here)
        others += way(f"{title}, d = {higher}", here.select(degree=higher), here)
        others += way(f"{title}, split", results.refined.select(mesh=mesh, method=method, degree=degree), here)
        finer = results.summary.select(mesh=mesh + REFINED, method=method, degree=degree)
        others += way(f"{title}, finer", finer, finer)
    return as_they_are + others if others else []


def way(title, solved, smoothed):
    """The first of the rows that are solved as a list of one Way, empty if there are none; smoothed: rows of its mesh."""
    if not len(solved):
        return []
    return [Way(title, solved.number(ERROR)[0], smoothing_seconds(smoothed) + solving_seconds(solved)[0])]


def with_best_alternative(results, key, others):
    """(the method's Way, the best of the others in no more time or None)."""
    mesh, degree, method = key
    rows = results.summary.select(mesh=mesh, degree=degree, method=method)
    found = way(results.title(method), rows, rows)
    own = found[0] if found else Way(results.title(method), math.nan, math.nan)
    in_time = [other for other in others if other.seconds <= own.seconds and not math.isnan(other.error)]
    return own, min(in_time, key=lambda other: other.error, default=None)


def method_solve_seconds(results, key):
    """Time of the solves that the method made, which is part of its smoothing."""
    mesh, degree, method = key
    seconds = results.iterations.select(mesh=mesh, degree=degree, method=method).number("method_solve_seconds")
    known = seconds[~(seconds != seconds)]
    return known[-1] if len(known) else math.nan


def verdict(own, best):
    """The verdict in words."""
    if math.isnan(own.error) or math.isnan(own.seconds):
        return MISSING
    return PAYS if best is None or own.error < best.error else DOES_NOT_PAY
