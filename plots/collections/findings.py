# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes findings on a collection as sentences, each with its number and interval."""

import math
from collections import Counter

import numpy as np

from ..results.collection import QUALITIES
from ..results.symbols import symbol_of
from ..statistics.bootstrap import interval
from .comparison import AS_IS, INITIAL_MESH, NEXT_DEGREE, SPLIT, has_result, payoffs, results_alone, shared_problems
from .problems import ERROR

SURE = 0.05  # a paired test below this distinguishes two methods
MOST_FAMILIES = 4  # that a sentence names
SCALES = "Error: the true H1 error, if nothing else is said. In brackets: intervals that hold 95 % of bootstrap samples."


def findings_as_markdown(results, problems, predictions, thresholds, of_families, ranks):
    """A page of sentences, from what the tables show."""
    sections = (("What was run", what_was_run(results, problems)),
                ("What predicts the error", what_predicts(predictions)),
                ("How good is good enough", what_is_enough(thresholds, of_families)),
                ("Which method", which_method(results, problems, ranks)),
                ("Does smoothing pay?", what_pays(results, problems)),
                ("What speaks against it", what_got_worse(results, problems)))
    lines = [f"# {results.study_title}: findings", "", SCALES]
    for heading, sentences in sections:
        if sentences:
            lines += ["", f"## {heading}", "", *(f"- {sentence}" for sentence in sentences)]
    return "\n".join(lines) + "\n"


def bracket(low_high, form=".2f"):
    """Writes an interval as (0.12 to 0.34), or says why there is none."""
    low, high = low_high
    return f" ({low:{form}} to {high:{form}})" if math.isfinite(low) else " (no interval: one mesh only)"


def counted(n, what, several=""):
    """"1 problem", "2 problems"."""
    return f"{n} {what if n == 1 else several or what + 's'}"


def what_was_run(results, problems):
    """Reports the numbers of members, and why some have failed."""
    states = Counter(results.members.text("status"))
    sentences = [f"{states['complete']} of {len(results.members)} members are complete: {counted(len(problems), 'problem')}, a member "
                 f"at a degree each, and {counted(len(results.methods), 'method')}."]
    failed = results.members.select(status="failed")
    reasons = Counter(zip(failed.text("family"), failed.text("reason")))
    return sentences + [f"Not run, {family}, {counted(n, 'member')}: {reason.rstrip('.')}."
                        for (family, reason), n in sorted(reasons.items())]


def what_predicts(predictions):
    """Reports the quality with the highest correlation with the error, for each type of elements and degree."""
    sentences = []
    for elements, degree in sorted({(p.elements, p.degree) for p in predictions}):
        known = [p for p in predictions if (p.elements, p.degree, p.outcome) == (elements, degree, ERROR)
                 and math.isfinite(p.across)]
        if not known:
            continue
        best = max(known, key=lambda p: abs(p.across))
        low, high = best.across_interval
        verdict = "goes best with the error" if low * high > 0 else "comes nearest to predicting the error, but its sign is not sure"
        # Of many qualities: the nearest ones, and the ones that methods of this program optimize.
        by_strength = sorted((p for p in known if p is not best), key=lambda p: -abs(p.across))
        others = ", ".join(f"{symbol_of(p.quality).text} {p.across:.2f}{bracket(p.across_interval)}"
                           for i, p in enumerate(by_strength) if i < 3 or p.quality in QUALITIES)
        within = (f" Among the meshes of one member it is {best.within:.2f}{bracket(best.within_interval)} in the middle."
                  if math.isfinite(best.within) else "")
        sentences.append(f"{elements.capitalize()}, d = {degree}: {symbol_of(best.quality).text} {verdict}: rank correlation "
                         f"{best.across:.2f}{bracket(best.across_interval)} over {best.n_records} meshes of "
                         f"{best.n_members} members; {others}.{within}")
    return sentences


def what_is_enough(thresholds, of_families):
    """Reports thresholds of the mean quality, the number that depends most on all cells. Families have different errors and
    qualities, so each has its own threshold."""
    sentences = []
    for elements, degree, quality, value, between in thresholds:
        if quality != "q_mean" or not math.isfinite(value):
            continue
        own = sorted((number, family) for *kind, family, number in of_families if kind == [elements, degree])
        symbol = symbol_of(quality).text
        if len(own) < 2:
            said = f"from {symbol} {value:.3f}{bracket(between, '.3f')} on the error falls by less than 5 %"
        elif len(own) <= MOST_FAMILIES:
            said = (f"the error falls by less than 5 % from {symbol} "
                    + ", ".join(f"{number:.3f} ({family})" for number, family in own) + " on")
        else:
            (low, lowest), (high, highest) = own[0], own[-1]
            said = (f"the error falls by less than 5 % from a {symbol} on that lies between {low:.3f} ({lowest}) and {high:.3f} "
                    f"({highest}) in {len(own)} families")
        sentences.append(f"{elements.capitalize()}, d = {degree}: {said}.")
    return sentences


def without_results(results, shared):
    """"where every method has a result (Laplace has none on 10)", and the methods that are not compared."""
    said = [f"{results.title(method)} has none on {n}" + ("" if method in shared.methods else " and is not compared")
            for method, n in shared.missing.items()]
    return f"where every compared method has a result without invalid cells ({', '.join(said)})"


def which_method(results, problems, ranks):
    """The first method, the methods that cannot be distinguished from it, and the others. Then the methods by their results."""
    if not ranks:
        return []
    best, others = ranks[0], ranks[1:]
    groups = "families" if all(problem.group == problem.family for problem in problems) else "meshes"

    def failures(method):
        n = sum(not has_result(problem, method) for problem in problems)
        return f" (1 on {n} of {counted(len(problems), 'problem')}, where it ends with invalid cells or has no result)" if n else ""

    sentences = [f"At equal budgets of time {results.title(best.method)} has the lowest mean rank, "
                 f"{best.rank:.2f}{bracket(best.rank_interval)}, and leaves {best.ratio:.3f}"
                 f"{bracket(best.ratio_interval, '.3f')} of the initial mesh's error{failures(best.method)}."]
    for entry in others:
        if entry.p_value < SURE:
            told = f"p = {entry.p_value:.2g} against the first"
        elif 2.0 / 2.0**entry.n_groups >= SURE:
            told = f"{entry.n_groups} {groups if entry.n_groups > 1 else 'mesh'} are too few to tell it from the first"
        else:
            told = f"cannot be told from the first (p = {entry.p_value:.2g})"
        sentences.append(f"{results.title(entry.method)}: mean rank {entry.rank:.2f}{bracket(entry.rank_interval)}, "
                         f"{entry.ratio:.3f}{bracket(entry.ratio_interval, '.3f')} of the initial error{failures(entry.method)}; {told}.")
    shared = shared_problems(problems, results.methods)
    if len(shared.methods) > 1:
        where = (f", on the {len(shared.problems)} of {counted(shared.n_all, 'problem')} {without_results(results, shared)}"
                 if shared.missing else "")
        sentences.append(f"By their results alone, whatever their time{where}: " + ", ".join(
            f"{results.title(method)} {ratio:.3f}" for method, ratio in results_alone(shared)) + " of the initial error.")
    interpreted = [results.title(method) for method in results.methods if method in results.interpreted]
    if interpreted and len(interpreted) < len(results.methods):
        sentences.append(f"Times of {', '.join(interpreted)} include the Python interpreter and cannot be compared with those of compiled "
                         "methods: compare the results.")
    return sentences


def what_pays(results, problems):
    """Compares smoothing with the next degree and with split cells on the unsmoothed mesh, for each family and degree;
    then the error at equal total time. Each comparison is on the problems where all methods have a result."""
    sentences, gains = [], []
    for family, degree in sorted({(problem.family, problem.degree) for problem in problems}):
        shared = shared_problems([p for p in problems if (p.family, p.degree) == (family, degree)], results.methods)
        here = {(p.method, p.change): p for p in payoffs(shared.problems, shared.methods, problems)}
        smoothed = [p for p in here.values() if p.change == AS_IS]
        best = min(smoothed, key=lambda p: p.error, default=None)
        if best is None:
            continue
        where = f"{family}, d = {degree}"
        if shared.missing:
            where += f", on the {len(shared.problems)} of {counted(shared.n_all, 'problem')} {without_results(results, shared)}"
        text = (f"{where}: {results.title(best.method)} leaves {best.error:.3f}"
                f"{bracket(best.error_interval, '.3f')} of the error for {best.time:.2g} times the time of one solution")
        for change, name, does in ((NEXT_DEGREE, "the next degree", f"degree {int(degree) + 1} on the unsmoothed mesh leaves"),
                                   (SPLIT, "splitting", "splitting every cell of the unsmoothed mesh leaves")):
            other = here.get((INITIAL_MESH, change))
            if other:
                fewer = f" on {other.n_problems} of these problems" if other.n_problems < len(shared.problems) else ""
                text += (f"; {does} {other.error:.3f}{bracket(other.error_interval, '.3f')} for {other.time:.2g} times{fewer}: "
                         f"{verdict(best, other, name)}")
        sentences.append(text + ".")
        fair = min((p for p in smoothed if math.isfinite(p.at_equal_time)), key=lambda p: p.at_equal_time, default=None)
        if fair:
            gains.append(fair)
            sentences.append(f"{where}, at equal time in all: of the methods {results.title(fair.method)} does best, with "
                             f"{fair.at_equal_time:.3f}{bracket(fair.at_equal_time_interval, '.3f')} of the unsmoothed mesh's error.")
    if gains:
        better, worse = (sum(1 for p in gains if test(*p.at_equal_time_interval))
                         for test in (lambda low, high: high < 1.0, lambda low, high: low > 1.0))
        sentences.insert(0, f"At equal time in all the best method's error is surely lower than the unsmoothed mesh's in {better} of "
                            f"{counted(len(gains), 'family and degree', 'families and degrees')}, surely higher in {worse}; in the "
                            "others the interval holds 1.")
    return sentences


def verdict(smoothed, other, name):
    """Says whether smoothing or the alternative has the lower error in no more time."""
    if smoothed.error <= other.error and smoothed.time <= other.time:
        return "smoothing pays"
    if other.error <= smoothed.error and other.time <= smoothed.time:
        return f"{name} is better and cheaper"
    return f"{name} is better, and dearer" if other.error < smoothed.error else "smoothing is better, and dearer"


def what_got_worse(results, problems):
    """Reports how often a method ends with a larger error than it began with."""
    sentences = []
    for method in results.methods:
        with_it = [problem for problem in problems if method in problem.curves]
        if any(method in problem.broken for problem in with_it):
            sentences.append(f"{results.title(method)} ends with invalid cells in "
                             f"{share(lambda p, m=method: m in p.broken, with_it)}.")
        with_it = [problem for problem in with_it if method not in problem.broken]
        if with_it:
            sentences.append(f"{results.title(method)} ends with a larger error than the initial mesh's in "
                             f"{share(lambda p, m=method: p.curves[m][ERROR][-1] > p.curves[m][ERROR][0], with_it)}.")
    return sentences


def share(test, problems):
    """The share of problems for which the test is true: "23 % (4 to 51) of 972 problems"."""
    percent = np.array([100.0 * test(problem) for problem in problems])
    between = interval(lambda rows: np.mean(percent[rows]), np.array([problem.group for problem in problems], dtype=str))
    return f"{np.mean(percent):.0f} %{bracket(between, '.0f')} of {counted(len(problems), 'problem')}"
