# SPDX-License-Identifier: GPL-3.0-or-later
"""The outcome of the study `elasticity`, by the criteria of its page (docs/explanation/elasticity-study.md)."""

import math

import numpy as np

from ..results.rows import read_rows
from .blocks import table

STUDIES = {"elasticity": "gear", "elasticity-beam": "beam", "elasticity-flange": "flange"}
METHOD = "getme-simultaneous"
SAME = (0.95, 1.05)  # as much as the other
LEAST_OF_TWELVE = 10
SOLVERS = {"cg_iterations": "CG", "jacobi_cg_iterations": "CG with Jacobi", "amg_cg_iterations": "CG with multigrid"}


class Pairs:
    """Numbers of meshes and degrees, before and after smoothing."""

    def __init__(self, reference):
        self.rows, self.keys = {}, []
        for study, name in STUDIES.items():
            for row in read_rows(reference / study / "summary.csv").records():
                key = (name, row["mesh"], int(row["degree"]))
                if key not in self.keys:
                    self.keys.append(key)
                self.rows[*key, row["method"]] = row

    def value(self, key, method, column):
        """A number; NaN if it is not known."""
        return float(self.rows[*key, method].get(column) or "nan")

    def ratio(self, key, column):
        """After smoothing over before."""
        return self.value(key, METHOD, column) / self.value(key, "initial", column)

    def locking(self, key, method):
        """The relative energy error with nu = .499, over that with nu = .3."""
        of = [self.value(key, method, f"{label}.energy_error") / math.sqrt(self.value(key, method, f"{label}.energy"))
              for label in ("incompressible", "compressible")]
        return of[0] / of[1]


def verdict(quotient, below, above):
    """below, above, or "as much"."""
    return below if quotient < SAME[0] else above if quotient > SAME[1] else "as much"


def blocks(reference):
    """{name of a block: Markdown}."""
    pairs = Pairs(reference)
    return {"help": helps(pairs), "locking": locking(pairs), "iterations": iterations(pairs)}


def helps(pairs):
    """Question 1."""
    rows, verdicts = [], []
    for key in pairs.keys:
        poisson, elastic = pairs.ratio(key, "h1_error"), pairs.ratio(key, "compressible.h1_error")
        verdicts.append(verdict(elastic / poisson, "more", "less"))
        rows.append((*key, f"{poisson:.3f}", f"{elastic:.3f}", f"{pairs.ratio(key, 'incompressible.h1_error'):.3f}".replace("nan", "–"),
                     verdicts[-1]))
    count = {word: verdicts.count(word) for word in ("more", "as much", "less")}
    decided = next((word for word in ("more", "less") if count[word] >= LEAST_OF_TWELVE), None)
    answer = f"smoothing helps elasticity {decided}" if decided else "it depends on the mesh"
    return (table(("domain", "mesh", "degree", "Poisson", "elasticity, nu .3", "nu .499", "verdict"), rows, "lllrrrl")
            + f"\n\nMore on {count['more']}, as much on {count['as much']}, less on {count['less']} of {len(rows)} pairs. **By the criterion, {answer}.**\n")


def locking(pairs):
    """Question 2."""
    rows, verdicts = [], []
    for key in pairs.keys:
        if key[2] != 1:
            continue
        before, after = pairs.locking(key, "initial"), pairs.locking(key, METHOD)
        verdicts.append(verdict(after / before, "less", "more"))
        rows.append((*key[:2], f"{before:.2f}", f"{after:.2f}", verdicts[-1]))
    answer = {("less",): "smoothing reduces locking", ("more",): "smoothing increases locking"}.get(tuple(set(verdicts)), "there is no claim")
    return table(("domain", "mesh", "L before", "L after", "locking"), rows, "llrrl") + f"\n\n**By the criterion, {answer}.**\n"


def iterations(pairs):
    """Question 3."""
    rows = []
    for label, nu in (("compressible", ".3"), ("incompressible", ".499")):
        for column, title in SOLVERS.items():
            solved = [key for key in pairs.keys if pairs.rows[*key, METHOD][f"{label}.n_dofs"]]
            ratios = np.array([pairs.ratio(key, f"{label}.{column}") for key in solved])
            known = ratios[np.isfinite(ratios)]
            numbers = (f"{np.exp(np.log(known).mean()):.2f}", f"{known.min():.2f} to {known.max():.2f}") if len(known) else ("–", "–")
            rows.append((nu, title, *numbers, len(known), len(ratios) - len(known)))
    return table(("nu", "solver", "mean R", "range", "pairs", "failed"), rows, "llrrrr") + "\n"
