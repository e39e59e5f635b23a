# SPDX-License-Identifier: GPL-3.0-or-later
"""Content of each table, as data. A new table is a new entry of TABLES; it needs no code."""

import math
from dataclasses import dataclass
from typing import Callable, Optional

from ..results.rows import ResultsError
from ..results.symbols import SYMBOLS, THESIS_NORMS, Heading
from . import number_format as form


@dataclass(frozen=True)
class Measure:
    """A column of the CSV files and how it is shown."""

    column: str
    heading: Heading
    format: Optional[Callable]  # None: the field as it stands in the file
    difference: bool = True  # whether a relative difference from the printed value makes sense
    unremarkable: tuple = ()  # the column is left out where all fields are one of these
    only_if_printed: bool = False  # the column is left out if the thesis has no printed value
    detail: bool = False  # the same if there is also a table of details
    ranks_methods: bool = True  # whether the methods' order by it is compared with the printed one
    of_thesis: bool = False  # the column is left out of studies that are not in the thesis
    tied: bool = False  # stays next to the column before it

    def numbers(self, fields):
        """Returns the fields of a column of a CSV file as numbers (None if they are shown as they stand) and as the
        table shows them. Raises ResultsError if one is not a number."""
        if self.format is None:
            return None, [field or form.MISSING for field in fields]
        try:
            values = [float(field) if field else math.nan for field in fields]
        except ValueError as error:
            raise ResultsError(f"Column `{self.column}` holds something that is not a number "
                               f"({error}).") from None
        values = [value if math.isfinite(value) else math.nan for value in values]
        return values, self.format(values)


@dataclass(frozen=True)
class TableDescription:
    """A table: which file, which content of the printed values, which keys and measures."""

    content: str  # also the file name where no printed table gives the number
    source: str  # summary or thresholds
    caption: str
    keys: tuple
    measures: tuple
    degree_independent: bool = False  # the same numbers stand in the rows of every degree
    pivot: bool = False  # rows of different methods become columns
    needs: str = ""  # the table is left out if the computed rows have nothing in this column


KEY_HEADINGS = {"mesh": Heading("Mesh", "Mesh"), "method": Heading("Method", "Method"),
                "degree": Heading("d", "$d$"), "error": Heading("Error", "Error")}


TIME = Heading("Time (s)", "Time (s)")
INVALID = Heading("Invalid", "Invalid")

SMOOTHING = TableDescription(
    content="smoothing", source="summary", keys=("mesh", "method"), degree_independent=True,
    caption="Performance of the smoothing methods",
    measures=(
        Measure("iterations", Heading("Iterations", "Iterations"), None, difference=False),
        Measure("smoothing_seconds", TIME, form.format_seconds, difference=False),
        Measure("preparation_seconds", Heading("Preparation (s)", "Preparation (s)"), form.format_seconds,
                difference=False, ranks_methods=False),
        Measure("peak_memory_gib", Heading("Memory (GiB)", "Memory (GiB)"), form.format_memory,
                difference=False, only_if_printed=True, ranks_methods=False),
        Measure("q_min", SYMBOLS["q_min"], form.format_quality),
        Measure("q_star_min", SYMBOLS["q_star_min"], form.format_quality, detail=True),
        Measure("q_mean", SYMBOLS["q_mean"], form.format_quality),
        Measure("n_invalid", INVALID, form.format_integer, unremarkable=("0",), detail=True)))

WARPAGE = TableDescription(
    content="warpage", source="summary", keys=("mesh", "method"), degree_independent=True,
    caption="Mean ratio of the cells and warpage of their quadrilateral faces", needs="w_mean",
    measures=tuple(Measure(name, SYMBOLS[name], form.format_quality)
                   for name in ("w_max", "w_mean", "q_min", "q_mean")))

SOLVER = TableDescription(
    content="solver", source="summary", keys=("mesh", "degree", "method"),
    caption="Performance of the CG solver",
    measures=(
        Measure("condition_number", SYMBOLS["condition_number"], form.format_scientific),
        Measure("jacobi_condition_number", SYMBOLS["jacobi_condition_number"], form.format_scientific),
        Measure("cg_iterations", SYMBOLS["cg_iterations"], form.format_integer),
        Measure("jacobi_cg_iterations", Heading("with Jacobi", "with Jacobi"), form.format_integer),
        Measure("cg_seconds", TIME, form.format_seconds, difference=False),
        Measure("amg_cg_iterations", Heading("with AMG", "with AMG"), form.format_integer),
        Measure("amg_setup_seconds", Heading("AMG setup (s)", "AMG setup (s)"), form.format_seconds,
                difference=False),
        Measure("amg_cg_seconds", Heading("AMG time (s)", "AMG time (s)"), form.format_seconds,
                difference=False)))

ERRORS = TableDescription(
    content="errors", source="summary", keys=("mesh", "degree", "method"),
    caption="Finite element solution errors",
    measures=(*(Measure(name, SYMBOLS[name], form.format_error) for name in ("h1_error", "l2_error", "h1_best", "l2_best")),
              *(Measure(name, SYMBOLS[name], form.format_error, of_thesis=True) for name in THESIS_NORMS)))

THRESHOLDS = TableDescription(
    content="thresholds", source="thresholds", keys=("mesh", "degree", "error"), pivot=True,
    caption="Smoothing time needed to reach an error threshold",
    measures=(
        Measure("threshold", Heading("Threshold", "Threshold"), form.format_error),
        Measure("reference_seconds", TIME, form.format_seconds, difference=False),
        Measure("method_seconds", TIME, form.format_seconds, difference=False),
        Measure("speedup", Heading("Speedup", "Speedup"), form.format_factor, difference=False, tied=True)))

DETAILS = TableDescription(
    content="details", source="summary", keys=("mesh", "degree", "method"),
    caption="Further quality numbers and extreme eigenvalues",
    needs="n_dofs",
    measures=(
        Measure("q_star_min", SYMBOLS["q_star_min"], form.format_quality),
        Measure("n_invalid", INVALID, form.format_integer, unremarkable=("0",)),
        Measure("n_dofs", Heading("Dofs", "Dofs"), form.format_integer),
        Measure("lambda_min", SYMBOLS["lambda_min"], form.format_scientific),
        Measure("lambda_max", SYMBOLS["lambda_max"], form.format_scientific),
        Measure("condition_residual", Heading("Eigen residual", "Eigen residual"),
                form.format_scientific),
        # That of planar studies by default; where methods differ, a reader has to know.
        Measure("condition_method", Heading("cond(A) by", r"$\mathrm{cond}(A)$ by"), None,
                difference=False, unremarkable=("lanczos+cholesky",)),
        Measure("status", Heading("Status", "Status"), None, difference=False,
                unremarkable=("ok", "not solved"))))

# What headings mean; below each table that has the column.
MEANINGS = {
    "iterations": "Iterations: all that were run, of each stage; the result can be the mesh of an earlier one",
    "preparation_seconds": "Preparation: work before the main loops, which Time does not include",
    "q_star_min": "q*_min: smallest mean ratio of the cells with a free node",
    "condition_residual": "Eigen residual: largest relative error that the extreme eigenvalues can have",
    "condition_method": "cond(A) by: how the condition number was computed",
    **dict.fromkeys(("jacobi_cg_iterations", "amg_cg_iterations"), "with Jacobi, with AMG: CG iterations with the diagonal or "
                    "algebraic multigrid as preconditioner"),
    **dict.fromkeys(("h1_error", "l2_error"), "H1 and L2 error: norms of the true error, solution less finite element solution"),
    **dict.fromkeys(("h1_best", "l2_best"), "least H1, least L2: the error of the best approximation, the closest function of the finite "
                    "element space with the same boundary values"),
    "jacobi_condition_number": "cond(A) scaled: of the matrix scaled by its diagonal, as Jacobi's preconditioner does; slightly too low",
    **dict.fromkeys(THESIS_NORMS, "e_max, e_mean, e_L2, e_H1: norms of the thesis, of the error at the nodes or of its "
                    "interpolant there")}
NORMS_MEANING = "Error: a norm of the thesis, of the error at the nodes or of its interpolant there; not the true error"

TABLES = (SMOOTHING, WARPAGE, SOLVER, ERRORS, THRESHOLDS, DETAILS)
