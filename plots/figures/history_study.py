# SPDX-License-Identifier: GPL-3.0-or-later
"""Selection and names of the histories of a study."""

from dataclasses import replace

import numpy as np

from ..results.names import find_column
from ..results.request import TIME
from ..results.rows import ResultsError, solves_itself
from ..results.smoothing import number_columns
from ..results.solvers import main_numbers, varying
from ..results.symbols import THESIS_NORMS
from .history import draw_history
from .history_lines import depends_on_degree
from .pages import fits_as_columns, pages
from .planned import PlannedFigure
from .thesis_numbers import HISTORY_DEGREES, THESIS_NUMBERS, figure_name

SOLVES = "n_solves"  # column of iterations.csv
PRINTED_COLUMNS = ("q_min", "q_mean", "e_max", "e_mean")  # of the figures in the thesis


def main_columns(results):
    """The default columns of the history."""
    return ("q_min", "q_mean", "h1_error", "l2_error") if results.degrees else ("q_star_min", "q_mean", "w_mean")


def plan_histories(results):
    """Quality and true errors against smoothing time, for each degree. A study with a figure in the thesis has this figure
    with its norms, too, and all norms of the thesis for each degree."""
    study, first = results.thesis_study, results.degrees[0] if results.degrees else ""
    is_printed = "history" in THESIS_NUMBERS.get(study, {})
    has_norms = is_printed and bool(results.degrees)
    shown = HISTORY_DEGREES.get(study, first)
    shown = shown if shown in results.degrees else first
    main = PRINTED_COLUMNS if has_norms else main_columns(results)
    prefix = "figure_history" if study in THESIS_NUMBERS else "history"
    planned = []

    def plan(prefix, variant, title, *arguments):
        planned.append(PlannedFigure(prefix + part + variant, title, lambda: draw_history(results, *arguments),
                                     whole=prefix + variant))
    for part, meshes in pages(results.meshes, fits_as_columns).items():
        for log_time, variant, title in ((False, "", "history"),
                                         (True, "_log_time", "history, log time")):
            plan(figure_name(study, "history"), variant, title, main, shown, log_time, meshes)
        for degree in results.degrees:
            # Without number: the thesis has no true errors, and its norms for one degree only.
            if has_norms or degree != shown:
                plan(prefix, f"_d{degree}", f"history, d = {degree}", main_columns(results), degree, False, meshes)
            if has_norms:
                plan(prefix, f"_norms_d{degree}", f"norms of the thesis, d = {degree}", THESIS_NORMS, degree, False, meshes)
    return planned + plan_solves(results) + plan_solvers(results)


def plan_solves(results):
    """True errors against the number of solves, of methods that solve by themselves."""
    methods = [method for method in results.methods if solves_itself(results.iterations.select(method=method))]
    planned = []
    if not methods:
        return planned
    for part, meshes in pages(results.meshes, fits_as_columns).items():
        for degree in results.degrees:
            planned.append(PlannedFigure(
                f"history_solves_d{degree}{part}", f"errors and solves, d = {degree}",
                lambda degree=degree, meshes=meshes: draw_history(results.restricted(methods), ("h1_error", "l2_error"),
                                                                  degree, False, meshes, SOLVES, True),
                whole=f"history_solves_d{degree}"))
    return planned


def plan_solvers(results):
    """The numbers of each solver that is not Poisson's against smoothing time, for each of its degrees."""
    planned = []
    for solver in results.solvers:
        columns = main_numbers(varying(solver.numbers, results.iterations) or solver.numbers)
        degrees = [degree for degree in solver.degrees if degree in results.degrees] or [*results.degrees, ""][:1]
        for part, meshes in pages(results.meshes, fits_as_columns).items():
            for degree in degrees:
                name, variant = f"solver_{solver.label}", "" if degree == degrees[0] else f"_d{degree}"
                planned.append(PlannedFigure(
                    name + part + variant, solver.title + (f", d = {degree}" if solver.degrees else ""),
                    lambda columns=columns, degree=degree, meshes=meshes: draw_history(results, columns, degree, False, meshes),
                    whole=name + variant))
    return planned


def plan_requested_history(results, request):
    """The history that a user asks for; raises ResultsError for a column that is not there or holds
    no numbers."""
    numbers = number_columns(results.iterations)
    y, x = (tuple(find_column(name, results.iterations.columns, numbers) for name in names if name)
            for names in (request.y, (request.x,)))
    request = replace(request, y=y, x="".join(x))
    for name in (*y, *x):
        if not np.isfinite(results.iterations.number(name)).any():
            raise ResultsError(f"{results.iterations.path}: column `{name}` has no numbers.")
    columns = request.y or main_columns(results)
    by_degree = len(results.degrees) > 1 and any(depends_on_degree(results, name) for name in (*columns, request.x or TIME))
    planned = []
    for part, meshes in pages(results.meshes, fits_as_columns).items():
        for degree in results.degrees if by_degree else (results.degrees or ("",))[:1]:
            variant = f"_d{degree}" if by_degree else ""
            planned.append(PlannedFigure(
                request.history_name + part + variant, "history", lambda degree=degree, meshes=meshes: draw_history(
                    results, columns, degree, request.log_x, meshes, request.x or TIME, request.log_y, request.x_range,
                    request.y_range),
                whole=request.history_name + variant, degree=variant and degree, meshes=tuple(meshes) if part else ()))
    return planned
