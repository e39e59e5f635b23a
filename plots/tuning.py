# SPDX-License-Identifier: GPL-3.0-or-later
"""python3 -m plots.tuning FOLDER: which of a study's methods has the lowest errors, found on half of its
meshes and confirmed on the other half.

All methods are compared with the first method. Every number is a geometric mean of ratios to it
over meshes, seeds and degrees, so that no mesh counts more than another. There are two rules.

At the end: the winner is the method with the lowest true errors (L2 and H1) on the first, third, ... mesh of
the study, among the methods that leave no cell invalid there, smooth in at most 1.1 times the time, and keep at least
half of q*_min. It is confirmed if its errors are below those of the first method on the second, fourth, ...
mesh, too.

At equal time (of 2026-11-25, after the first rule had been applied in the plane): the same with the numbers that
each method has after the time the first method takes to its end, on a straight line between two records, and
without a condition on time. By the first rule, a method that is ahead at all times but continues longer loses. Most of
the time to the end is that of the sequential stage, which improves the worst cell and hardly changes errors.
"""

import math
import sys
from dataclasses import dataclass

import numpy as np

from .results.rows import ResultsError
from .results.smoothing import read_results

ERRORS = ("l2_error", "h1_error")
COLUMNS = (*ERRORS, "q_star_min", "q_mean", "smoothing_seconds")
LEAST_Q = 0.5


@dataclass(frozen=True)
class Rule:
    """The numbers of a method that count, and the time it may take."""

    title: str
    numbers: object  # (results, mesh, method) -> {column: a number for each degree}
    most_time: float  # of the first method's


@dataclass(frozen=True)
class Candidate:
    """A method on some meshes: ratios of its numbers to the first method's, by column."""

    method: str
    ratios: dict
    n_invalid: int
    most_time: float

    @property
    def error(self):
        """The geometric mean of both errors."""
        return geometric_mean([self.ratios[name] for name in ERRORS])

    @property
    def is_allowed(self):
        """True if it may win, independent of its errors."""
        return (self.n_invalid == 0 and self.ratios["smoothing_seconds"] <= self.most_time
                and self.ratios["q_star_min"] >= LEAST_Q)


def at_end(results, mesh, method):
    """The numbers of the mesh that the method ends with."""
    rows = results.summary.select(mesh=mesh, method=method)
    return {name: rows.number(name) for name in COLUMNS}


def at_equal_time(results, mesh, method):
    """The numbers at the time when the first method ends; `smoothing_seconds` is the method's own, to its end."""
    numbers = at_end(results, mesh, method)
    budget = results.summary.select(mesh=mesh, method=results.methods[0]).number("smoothing_seconds")[0]
    rows = [results.iterations.select(mesh=mesh, method=method, degree=degree) for degree in results.degrees]
    for name in (*ERRORS, "q_star_min", "q_mean"):
        numbers[name] = np.array([np.interp(budget, each.number("smoothing_seconds"), each.number(name)) for each in rows])
    return numbers


RULES = (Rule("At the end", at_end, most_time=1.1), Rule("At equal time", at_equal_time, most_time=math.inf))


def geometric_mean(values):
    """The geometric mean; 0 if a number is 0, NaN if a number is NaN."""
    values = np.asarray(values, dtype=float)
    return float(np.exp(np.mean(np.log(values)))) if (values > 0).all() else float(np.min(values))


def halves(meshes):
    """The meshes to find the winner on, and those to confirm it on."""
    return meshes[::2], meshes[1::2]


def candidates(results, meshes, rule):
    """Every method on these meshes by one of the rules."""
    everywhere = (results, *results.repetitions)
    first = results.methods[0]
    found = []
    for method in results.methods:
        ratios = {name: [] for name in COLUMNS}
        n_invalid = 0
        for each in everywhere:
            for mesh in meshes:
                n_invalid += int(np.nansum(each.summary.select(mesh=mesh, method=method).number("n_invalid")))
                own, base = (rule.numbers(each, mesh, m) for m in (method, first))
                for name in COLUMNS:
                    ratios[name] += list(own[name] / base[name])
        means = {name: geometric_mean(values) for name, values in ratios.items()}
        found.append(Candidate(method, means, n_invalid, rule.most_time))
    return found


def winner(found):
    """Returns the candidate with the lowest errors among candidates that may win."""
    return min((c for c in found if c.is_allowed and not math.isnan(c.error)), key=lambda c: c.error)


def report(results):
    """The results of both rules, as Markdown."""
    first, second = (", ".join(half) for half in halves(results.meshes))
    lines = [f"# {results.study_title}", "",
             f"Found on: {first}. Confirmed on: {second}. Seeds: {', '.join(map(str, results.seeds)) or 1}. "
             f"Ratios to {results.title(results.methods[0])}, geometric means; below 1 is better for errors and "
             "time."]
    for rule in RULES:
        lines += ["", *finding(results, rule)]
    return "\n".join(lines) + "\n"


def finding(results, rule):
    """Lines of the table of all candidates on both halves by one rule, best first, and what follows."""
    found, confirmed = (candidates(results, half, rule) for half in halves(results.meshes))
    best = winner(found)
    there = next(c for c in confirmed if c.method == best.method)
    verdict = "confirmed" if there.error < 1 else "not confirmed"
    found_out = (f"errors {best.error:.3f} times as large, and {there.error:.3f} times on the other half: {verdict}"
                 if best.method != results.methods[0] else "none of the others that may win has lower errors")
    lines = [f"{rule.title}: **{results.title(best.method)}**, {found_out}.", "",
             "| | errors | L2 | H1 | q*_min | q_mean | time | errors, other half | L2 | H1 | q*_min | q_mean | time |",
             "|:--|" + "--:|" * 12]
    for one in sorted(found, key=lambda c: c.error):
        other = next(c for c in confirmed if c.method == one.method)
        cells = [f"{value:.3f}" for half in (one, other) for value in (half.error, *half.ratios.values())]
        mark = "" if one.is_allowed else " (may not win)"
        lines.append(f"| {results.title(one.method)}{mark} | {' | '.join(cells)} |")
    return lines


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
