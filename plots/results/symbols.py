# SPDX-License-Identifier: GPL-3.0-or-later
"""Displayed names of the columns of the CSV files."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Heading:
    """A column's heading for plain text and for LaTeX."""

    text: str
    tex: str


SYMBOLS = {
    "q_min": Heading("q_min", r"$q_{\min}$"), "q_mean": Heading("q_mean", r"$q_{\mathrm{mean}}$"),
    "q_star_min": Heading("q*_min", r"$q^{*}_{\min}$"),
    "e_max": Heading("e_max", r"$e_{\max}$"), "e_mean": Heading("e_mean", r"$e_{\mathrm{mean}}$"),
    "e_l2": Heading("e_L2", r"$e_{L^2}$"), "e_h1": Heading("e_H1", r"$e_{H^1}$"),
    "l2_error": Heading("L2 error", r"$\Vert u-u_h\Vert_{L^2}$"),
    "h1_error": Heading("H1 error", r"$\Vert u-u_h\Vert_{H^1}$"),
    "l2_best": Heading("least L2", r"$\min_v\Vert u-v\Vert_{L^2}$"),
    "h1_best": Heading("least H1", r"$\min_v\Vert u-v\Vert_{H^1}$"),
    "jacobi_condition_number": Heading("cond(A) scaled", r"$\mathrm{cond}(D^{-1/2}AD^{-1/2})$"),
    "lambda_min": Heading("lambda_min", r"$\lambda_{\min}$"),
    "lambda_max": Heading("lambda_max", r"$\lambda_{\max}$"),
    "w_max": Heading("w_max", r"$w_{\max}$"), "w_mean": Heading("w_mean", r"$w_{\mathrm{mean}}$"),
    "condition_number": Heading("cond(A)", r"$\mathrm{cond}(A)$"),
    "cg_iterations": Heading("CG iterations", "CG iterations"),
    "jacobi_cg_iterations": Heading("CG Jacobi", "CG iterations, Jacobi"),
    "amg_cg_iterations": Heading("CG multigrid", "CG iterations, multigrid"),
    "energy_error": Heading("Energy error", r"$\Vert u-u_h\Vert_a$"),
    "von_mises_error": Heading("Stress error", "Largest error of the von Mises stress"),
    "von_mises_max": Heading("Largest stress", "Largest von Mises stress"), "u_max": Heading("Largest u", r"$\max|u_h|$"),
    "smoothing_seconds": Heading("Smoothing time (s)", "Smoothing time (s)"),
    "iteration": Heading("Iteration", "Iteration"), "n_solves": Heading("Solves", "Solves"),
}


# Norms of the nodal interpolant of the error, as in the thesis. The true errors are h1_error and l2_error.
THESIS_NORMS = ("e_max", "e_mean", "e_l2", "e_h1")

# For file names.
SHORT_COLUMNS = {"h1_error": "h1", "l2_error": "l2", "condition_number": "cond", "cg_iterations": "cg",
                 "smoothing_seconds": "time", "preparation_seconds": "preparation", "iteration": "iterations"}


# How columns begin that have a point, but no solver: n_below_0.3.
COUNTS_BELOW = ("n_below_", "n_star_below_")


def of_solver(column):
    """(label, number) of a solver's column LABEL.NUMBER; an empty label and the column for any other."""
    label, _, number = column.rpartition(".")
    return (label, number) if label and not column.startswith(COUNTS_BELOW) else ("", column)


def short_column(column):
    """A short name of a column: h1 for h1_error, plate_h1 for plate.h1_error."""
    label, number = of_solver(column)
    return "_".join(filter(None, (label, SHORT_COLUMNS.get(number, number))))


def symbol_of(column):
    """The heading of a column; the name of one that has none. That of a solver begins with its label."""
    label, number = of_solver(column)
    symbol = SYMBOLS.get(number, Heading(number, number))
    return Heading(f"{label}: {symbol.text}", f"{label}: {symbol.tex}") if label else symbol
