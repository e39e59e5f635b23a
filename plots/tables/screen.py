# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a short summary of the results of each method on each mesh for the end of a study."""

import math

from ..results.smoothing import INITIAL
from .number_format import MISSING, format_quality, seconds_text
from .sessions import times_sentence
from .smoothing import invalid_meshes

MAX_ROWS = 40  # of all meshes and degrees together; the tables have the others
BEST = "*"
FINE = ("ok", "not solved")  # statuses of methods that can be the best


def best_of(values, choose):
    """The best of the numbers; NaN for an empty list."""
    return choose((value for value in values if not math.isnan(value)), default=math.nan)


class Column:
    """A column: heading, how a number is written, and which number is best (max, min or None)."""

    def __init__(self, heading, value, text, best=None):
        self.heading, self.value, self.text, self.best = heading, value, text, best


def number(row, name):
    """A field of a row as a number; NaN if it is empty."""
    field = row.get(name, "")
    return float(field) if field else math.nan


def smoothing_seconds(row, _):
    """Preparation and main loops."""
    return number(row, "smoothing_seconds") + (number(row, "preparation_seconds") if row.get("preparation_seconds") else 0.0)


def factor(name):
    """The function that divides a row's number by that of the initial mesh."""
    return lambda row, initial: number(row, name) / number(initial, name) if number(initial, name) else math.nan


def plain(name):
    """The function that takes a row's number as it is."""
    return lambda row, initial: number(row, name)


def quality_text(value):
    """Four decimals; tiny numbers are not shown as zero, which invalid meshes have."""
    return format_quality([value])[0]


QUALITY = (Column("q_min", plain("q_min"), quality_text, max), Column("q_mean", plain("q_mean"), quality_text, max))
TIME = (Column("time [s]", smoothing_seconds, seconds_text),)
SOLUTION = (Column("H1 error", factor("h1_error"), "{:.3f}".format, min), Column("L2 error", factor("l2_error"), "{:.3f}".format, min),
            Column("CG", plain("cg_iterations"), "{:.0f}".format, min))
ERRORS = "H1 and L2 error: true errors, as factors of the initial mesh's. CG: iterations."


def screen(results):
    """The text: one block for each mesh and degree, one line a method, the best numbers marked; below it each method
    that failed, with its reason."""
    has_solutions = any(row.get("h1_error") for row in results.summary.records())
    columns = (*QUALITY, *(SOLUTION if has_solutions else ()), *TIME)
    lines, n_rows, left_out = problem_lines(results.provenance), 0, []
    for mesh in results.meshes:
        for degree in results.degrees or ("",):
            rows = {row["method"]: row for row in results.summary.select(mesh=mesh).records() if row.get("degree", "") == degree}
            block = block_lines(results, mesh, degree, rows, columns)
            if n_rows and n_rows + len(block) > MAX_ROWS:
                left_out.append(block[0])
                continue
            lines += block
            n_rows += len(block)
    lines += [f"Failed: {results.title(method)} on {results.title(mesh)}: {status.removeprefix('failed: ')}"
              for (mesh, method), status in results.failures.items()]
    lines += [f"Invalid: {sentence}" for _, sentence in invalid_meshes(results.summary.records(), results)]
    if left_out:
        lines.append(f"The tables also have: {'; '.join(left_out[:5])}{' and others' if len(left_out) > 5 else ''}.")
    lines.append(f"{BEST} best of the methods." + (f" {ERRORS}" if has_solutions else ""))
    lines += [sentence for sentence in [times_sentence(results)] if sentence]
    return "\n".join(lines) + "\n"


def problem_lines(provenance):
    """The problem that is solved: one line for each solution, and one for the boundary and the load."""
    problem = provenance.get("problem")
    if not problem:
        return []
    lines = [f"Problem{' ' + entry['label'] if 'label' in entry else ''}: -div(A grad u) = f, u = {entry['u']}"
             + (f", A = {entry['A']}" if entry["A"] != "1" else "") for entry in problem["solutions"]]
    natural = f"natural conditions on {', '.join(problem['natural'])}, u given elsewhere" if problem.get("natural") else "u given"
    load = {"nodal": "f interpolated (protocol of Chapter 6)", "quadrature": "f integrated"}.get(problem["load"], problem["load"])
    return lines + [f"Boundary: {natural}. Load: {load}."]


def block_lines(results, mesh, degree, rows, columns):
    """Heading and lines of one mesh and degree."""
    initial = rows.get(INITIAL, {})
    failed = {method for name, method in results.failures if name == mesh}
    methods = [method for method in (INITIAL, *results.methods) if method in rows and method not in failed]
    numbers = {method: [column.value(rows[method], initial) for column in columns] for method in methods}
    judged = [method for method in methods if method != INITIAL and rows[method].get("status", "ok") in FINE]
    best = [best_of((numbers[method][i] for method in judged), column.best) if column.best else None
            for i, column in enumerate(columns)]
    width = max(len(results.title(method)) for method in (*methods, INITIAL))
    title = results.title(mesh) + (f", degree {degree}" if degree else "")
    lines = [title, " " * (width + 2) + " ".join(f"{column.heading:>10}" for column in columns)]
    for method in methods:
        cells = [cell(value, column, method in judged and value == best[i])
                 for i, (value, column) in enumerate(zip(numbers[method], columns))]
        status = rows[method].get("status", "ok")
        lines.append(f"  {results.title(method):<{width}}" + " ".join(cells) + ("" if status in FINE else f"  {status}"))
    return lines


def cell(value, column, is_best):
    """A number of ten characters, the mark of the best behind it."""
    text = MISSING if math.isnan(value) else column.text(value)
    return f"{text + (BEST if is_best else ' '):>10}"
