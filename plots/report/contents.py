# SPDX-License-Identifier: GPL-3.0-or-later
"""Content of a report, as data: curves, rows of tables, meshes, claims, a comparison with another folder."""

import math

import numpy as np

from ..results.rows import ResultsError
from ..results.smoothing import INITIAL, read_results
from ..results.solvers import main_numbers
from ..results.symbols import THESIS_NORMS, symbol_of
from .looks import looks_of
from .mesh_views import mesh_view

# Columns that may be drawn against one another, besides those of other solvers; those without a number are left out.
DRAWN = ("iteration", "smoothing_seconds", "wall_seconds", "q_min", "q_star_min", "q_mean", "n_invalid", "w_mean",
         "condition_number", "cg_iterations", "jacobi_cg_iterations", "amg_cg_iterations", "h1_error", "l2_error",
         *THESIS_NORMS)
# Columns of summary.csv that say which row it is.
KEYS = ("mesh", "method", "degree")
COMPARED = ("h1_error", "l2_error", "q_min", "q_mean", "condition_number", "cg_iterations", "smoothing_seconds")
# Of summary.csv, before and after all its other columns: answers first, facts on how they were found last.
FIRST = (*KEYS, "status", "q_min", "q_mean", "n_invalid", "h1_error", "l2_error", "cg_iterations", "cg_seconds", "smoothing_seconds",
         "wall_seconds", "iterations", "condition_number")
LAST = ("lambda_min", "lambda_max", "condition_method", "condition_residual", "cg_converged", "n_dofs", "n_free", "peak_memory_gib")


def number_or_none(value):
    """Replaces NaN and infinity by None, as JSON has neither."""
    return float(value) if math.isfinite(value) else None


def curves(results):
    """Column -> numbers of every row of iterations.csv, and the keys of the rows."""
    rows = results.iterations
    columns = {}
    described = {name: words for solver in results.solvers for name, words in solver.described.items()}
    for name in (*DRAWN, *(name for solver in results.solvers for name in solver.columns)):
        values = rows.number(name)
        if np.isfinite(values).any():
            columns[name] = [number_or_none(value) for value in values]
    return {"keys": {name: list(rows.text(name)) for name in KEYS}, "columns": columns,
            "headings": {name: heading_of(name, described.get(name, ("", ""))[0]) for name in columns},
            "meanings": {name: f"{meaning}." for name, (_, meaning) in described.items() if meaning and name in columns}}


def heading_of(column, unit=""):
    """The heading of a column; norms of the thesis are called so, as they are not the true errors."""
    return symbol_of(column).text + (f" [{unit}]" if unit else "") + (" (norm of the thesis)" if column in THESIS_NORMS else "")


def summary_table(results):
    """Headings and rows of summary.csv, qualities, errors and times first, without the study's name and without columns that
    are empty."""
    rows = results.summary
    names = [name for name in dict.fromkeys((*FIRST, *(name for name in rows.columns if name not in LAST), *LAST))
             if name in rows.columns and name != "study" and any(rows.text(name))]
    return {"headings": [heading_of(name) for name in names],
            "rows": [[cell(name, field, results) for name, field in zip(names, fields)]
                     for fields in zip(*(rows.text(name) for name in names))]}


def cell(name, field, results):
    """The displayed text of a field, and the number it is sorted by, if it is one."""
    if name in ("mesh", "method"):
        return {"text": results.title(field)}
    try:
        value = float(field)
    except ValueError:
        return {"text": field}
    return {"text": f"{value:.6g}", "order": value}


def comparison(results, against):
    """Divides this folder's numbers by another's, row by row of those in both. Raises ResultsError if there is no
    common row."""
    other = read_results(against)
    others = {tuple(row[key] for key in KEYS): row for row in other.summary.records()}
    rows, names = [], (*COMPARED, *(name for solver in results.solvers for name in main_numbers(solver.numbers)))
    for row in results.summary.records():
        key = tuple(row[key] for key in KEYS)
        if key in others:
            rows.append([{"text": results.title(row["mesh"])}, {"text": results.title(row["method"])},
                         {"text": row["degree"]}, *(ratio(row.get(name), others[key].get(name)) for name in names)])
    if not rows:
        raise ResultsError(f"{against}: no mesh, method and degree of this folder is in {results.folder}; compare "
                           "results of the same study.")
    return {"headings": ["Mesh", "Method", "degree", *(symbol_of(name).text for name in names)], "rows": rows,
            "made_by": other.provenance.get("program", {}).get("commit", ""), "study": other.study_title}


def ratio(this, others):
    """Returns the quotient of both numbers, `=` if they are bitwise identical."""
    try:
        this, others = float(this or "nan"), float(others or "nan")
    except ValueError:
        this = others = math.nan
    if not (math.isfinite(this) and math.isfinite(others)):
        return {"text": ""}
    if this == others:
        return {"text": "=", "order": 1.0}
    return {"text": f"{this / others:.4g}", "order": this / others} if others else {"text": f"{this:.4g} / 0"}


def contents(results):
    """All of it that the page's script draws, ready for JSON."""
    views = {mesh: view for mesh in results.meshes if (view := mesh_view(results, mesh)) is not None}
    return {"meshes": list(results.meshes), "methods": [INITIAL, *results.methods], "degrees": list(results.degrees),
            "titles": {name: results.title(name) for name in (*results.meshes, INITIAL, *results.methods)},
            "looks": looks_of(results.study_methods or results.methods),
            "curves": curves(results), "views": views}
