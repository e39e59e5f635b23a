# SPDX-License-Identifier: GPL-3.0-or-later
"""python3 -m plots.tuning FOLDER: which of a study's methods has the lowest errors, found on half of its
meshes and confirmed on the other half.

The first method is what the others are compared with. Every number is a geometric mean of ratios to it
over meshes, seeds and degrees, so that no mesh counts more than another. The rule, in words: the winner is
the method with the lowest true errors (L2 and H1) on the first, third, ... mesh of the study, among those
that leave no cell invalid there, smooth in at most 1.1 times the time, and keep at least half of q*_min. It
is confirmed if its errors are below those of the first method on the second, fourth, ... mesh, too.
"""

import math
import sys
from dataclasses import dataclass

import numpy as np

from .results.rows import ResultsError
from .results.smoothing import read_results

ERRORS = ("l2_error", "h1_error")
COLUMNS = (*ERRORS, "q_star_min", "q_mean", "smoothing_seconds")
MOST_TIME, LEAST_Q = 1.1, 0.5


@dataclass(frozen=True)
class Candidate:
    """A method on some meshes: ratios of its numbers to the first method's, by column."""

    method: str
    ratios: dict
    n_invalid: int

    @property
    def error(self):
        """Of both errors."""
        return geometric_mean([self.ratios[name] for name in ERRORS])

    @property
    def is_allowed(self):
        """Whether it may win, whatever its errors."""
        return (self.n_invalid == 0 and self.ratios["smoothing_seconds"] <= MOST_TIME
                and self.ratios["q_star_min"] >= LEAST_Q)


def geometric_mean(values):
    """0 if one of them is 0, NaN if one of them is none."""
    values = np.asarray(values, dtype=float)
    return float(np.exp(np.mean(np.log(values)))) if (values > 0).all() else float(np.min(values))


def halves(meshes):
    """The meshes to find the winner on, and those to confirm it on."""
    return meshes[::2], meshes[1::2]


def candidates(results, meshes):
    """Every method on these meshes."""
    everywhere = (results, *results.repetitions)
    first = results.methods[0]
    found = []
    for method in results.methods:
        ratios = {name: [] for name in COLUMNS}
        n_invalid = 0
        for each in everywhere:
            for mesh in meshes:
                ours, base = (each.summary.select(mesh=mesh, method=m) for m in (method, first))
                n_invalid += int(np.nansum(ours.number("n_invalid")))
                for name in COLUMNS:
                    ratios[name] += list(ours.number(name) / base.number(name))
        means = {name: geometric_mean(values) for name, values in ratios.items()}
        found.append(Candidate(method, means, n_invalid))
    return found


def winner(found):
    """The candidate with the lowest errors of those that may win."""
    return min((c for c in found if c.is_allowed and not math.isnan(c.error)), key=lambda c: c.error)


def report(results):
    """The table of all candidates on both halves, best first, and what follows, as Markdown."""
    found, confirmed = (candidates(results, half) for half in halves(results.meshes))
    best = winner(found)
    there = next(c for c in confirmed if c.method == best.method)
    first, second = (", ".join(half) for half in halves(results.meshes))
    verdict = "confirmed" if there.error < 1 else "not confirmed"
    lines = [f"# {results.study_title}", "",
             f"Found on: {first}. Confirmed on: {second}. Seeds: {', '.join(map(str, results.seeds)) or 1}. "
             f"Ratios to {results.title(results.methods[0])}, geometric means; below 1 is better for errors and "
             "time.", "",
             f"**{results.title(best.method)}**: errors {best.error:.3f} times as large, and {there.error:.3f} "
             f"times on the other half: {verdict}.", "",
             "| | errors | L2 | H1 | q*_min | q_mean | time | errors, other half | L2 | H1 | q*_min | q_mean | time |",
             "|:--|" + "--:|" * 12]
    for one in sorted(found, key=lambda c: c.error):
        other = next(c for c in confirmed if c.method == one.method)
        cells = [f"{value:.3f}" for half in (one, other) for value in (half.error, *half.ratios.values())]
        mark = "" if one.is_allowed else " (may not win)"
        lines.append(f"| {results.title(one.method)}{mark} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def main(arguments):
    """Prints the report; returns the exit code."""
    if len(arguments) != 1:
        print("usage: python3 -m plots.tuning FOLDER", file=sys.stderr)
        return 2
    try:
        print(report(read_results(arguments[0])), end="")
    except (ResultsError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
