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
    "l2_error": Heading("|u-u_h|_L2", r"$\Vert u-u_h\Vert_{L^2}$"),
    "h1_error": Heading("|u-u_h|_H1", r"$\Vert u-u_h\Vert_{H^1}$"),
    "lambda_min": Heading("lambda_min", r"$\lambda_{\min}$"),
    "lambda_max": Heading("lambda_max", r"$\lambda_{\max}$"),
    "w_max": Heading("w_max", r"$w_{\max}$"), "w_mean": Heading("w_mean", r"$w_{\mathrm{mean}}$"),
    "condition_number": Heading("cond(A)", r"$\mathrm{cond}(A)$"),
    "cg_iterations": Heading("CG iterations", "CG iterations"),
    "smoothing_seconds": Heading("Smoothing time (s)", "Smoothing time (s)"),
    "iteration": Heading("Iteration", "Iteration"), "n_solves": Heading("Solves", "Solves"),
}


def symbol_of(column):
    """The heading of a column; the name of one that has none."""
    return SYMBOLS.get(column, Heading(column, column))
