# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes findings on a collection as sentences, each with its number and interval."""

import math
from collections import Counter

from ..results.symbols import of_solver, symbol_of
from .comparison import AS_IS, INITIAL_MESH, NEXT_DEGREE, SPLIT, SURE, can_test
from .orders import ERRORS, LEAST_CHANGE, changed
from .prediction import differ
from .problems import AS_GENERATED, ERROR

SCALES = ("Error: the true H1 error. Ratios are errors after over before smoothing. Means are over families (domains), each counted once; in "
          "brackets: 95 % intervals of these means. A method without a valid result leaves the initial mesh, ratio 1.")
OWN_MEASURE = "q_mean"  # what methods of this program optimize
MOST_KINDS = 3  # of meshes that a sentence names


def findings_as_markdown(results, problems, found, budgets, alternatives, predictions, orders=(), of_solvers=()):
    """A page of sentences, from what the tables show: gains, gains at budgets, payoffs, predictions, orders, and for each further
    solver its gains by number."""
    sections = (("What was run", what_was_run(results, problems)),
                ("How much", how_much(results, found)),
                ("Which method", which_method(results, found)),
                ("Other solvers", [sentence for by_number in of_solvers for sentence in what_others_say(results, by_number)]),
                ("At equal times", at_equal_times(results, budgets)),
                ("Does smoothing pay?", what_pays(results, alternatives)),
                ("Order or constant", what_orders(results, orders)),
                ("What speaks against it", what_got_worse(results, found)),
                ("What predicts the error", what_predicts(predictions)))
    lines = [f"# {results.study_title}: findings", "", SCALES]
    for heading, sentences in sections:
        if sentences:
            lines += ["", f"## {heading}", "", *(f"- {sentence}" for sentence in sentences)]
    return "\n".join(lines) + "\n"


def bracket(low_high, form=".2f"):
    """Writes an interval as (0.12 to 0.34), or says why there is none."""
    low, high = low_high
    return f" ({low:{form}} to {high:{form}})" if math.isfinite(low) else " (no interval: one family only)"


def counted(n, what, several=""):
    """"1 problem", "2 problems"."""
    return f"{n} {what if n == 1 else several or what + 's'}"


def kind_of(entry):
    """"Triangles, degree 1, distorted to 0.45"."""
    level = entry.level if entry.level == AS_GENERATED else f"distorted to {entry.level}"
    return ", ".join([entry.elements.capitalize(), *([f"degree {entry.degree}"] if entry.degree else []), level])


def of_kinds(entries):
    """Lists of entries of one kind of meshes, in their order."""
    found = {}
    for entry in entries:
        found.setdefault((entry.elements, entry.degree, entry.level), []).append(entry)
    return list(found.values())


def percent(share):
    """"4 %"; "less than 1 %" for a small share that is not 0."""
    return "less than 1 %" if 0.0 < share < 0.01 else f"{100.0 * share:.0f} %"


def what_was_run(results, problems):
    """Reports the numbers of members, and why some have failed."""
    states = Counter(results.members.text("status"))
    sentences = [f"{states['complete']} of {len(results.members)} members are complete: {counted(len(problems), 'problem')}, a member "
                 f"at a degree each, and {counted(len(results.methods), 'method')}."]
    failed = results.members.select(status="failed")
    reasons = Counter(zip(failed.text("family"), failed.text("reason")))
    return sentences + [f"Not run, {family}, {counted(n, 'member')}: {reason.rstrip('.')}."
                        for (family, reason), n in sorted(reasons.items())]


def what_others_say(results, by_number):
    """The gain of the reference method, and the other methods, by one number of a further solver: the H1 error, or the first one."""
    column = next((name for name in by_number if of_solver(name)[1] == ERROR), next(iter(by_number), None))
    if column is None:
        return []
    label, number = of_solver(column)
    words = f"{symbol_of(number).text} of {label}"
    return how_much(results, by_number[column], f"the {words}") + which_method(results, by_number[column], f"{words} over that")


def how_much(results, found, what="the error"):
    """The gain of the reference method on each kind of meshes."""
    return [f"{kind_of(gain)}: {results.title(gain.method)} leaves {gain.ratio:.3f}{bracket(gain.interval, '.3f')} of {what}, on "
            f"{counted(gain.n_problems, 'problem')} of {counted(gain.n_families, 'family', 'families')}. It raises it by more than 1 % on "
            f"{percent(gain.worse)}" + (f", and has no valid result on {percent(gain.failed)}" if gain.failed else "") + " of them."
            for gain in found if gain.method == results.methods[0]]


def which_method(results, found, what="errors over those"):
    """The errors of the other methods over the reference method's, the least first."""
    sentences = []
    for of_kind in of_kinds(found):
        others = sorted((gain for gain in of_kind if gain.method != results.methods[0]), key=lambda gain: gain.over_reference)
        if not others:
            continue
        text = ", ".join(f"{results.title(gain.method)} {gain.over_reference:.3f}{bracket(gain.over_reference_interval, '.3f')}"
                         for gain in others)
        differing = [f"{results.title(gain.method)} (p = {gain.p_value:.2g})" for gain in others if gain.p_value < SURE]
        if not can_test(of_kind[0], len(results.methods)):
            told = f"{counted(of_kind[0].n_families, 'family is', 'families are')} too few for any test to separate methods"
        elif differing:
            told = f"different from {results.title(results.methods[0])}, by an adjusted test: {', '.join(differing)}"
        else:
            told = f"no test separates one of them from {results.title(results.methods[0])}"
        sentences.append(f"{kind_of(of_kind[0])}, {what} of {results.title(results.methods[0])}: {text}; {told}.")
    interpreted = [results.title(method) for method in results.methods if method in results.interpreted]
    if sentences and interpreted and len(interpreted) < len(results.methods):
        sentences.append(f"Times of {', '.join(interpreted)} include the Python interpreter and cannot be compared with those of compiled "
                         "methods: compare the results.")
    return sentences


def at_equal_times(results, found):
    """The method with the lowest error within each budget, and the reference method's."""
    sentences = []
    for of_kind in of_kinds(found):
        said = []
        for budget in sorted({entry.budget for entry in of_kind}):
            best, *others = sorted((entry for entry in of_kind if entry.budget == budget), key=lambda entry: entry.ratio)
            near = [results.title(entry.method) for entry in others if entry.ratio < 1.01 * best.ratio]
            said.append(f"{budget:g} of its time: {results.title(best.method)} {best.ratio:.3f}{bracket(best.interval, '.3f')}"
                        + (f" (within 1 %: {', '.join(near)})" if near else ""))
        sentences.append(f"{kind_of(of_kind[0])}, one solution on the initial mesh as unit, lowest ratio after {'; '.join(said)}.")
    return sentences


def what_pays(results, found):
    """Compares the reference method's mesh with the next degree and with split cells on the unsmoothed mesh."""
    sentences = []
    for of_kind in of_kinds(found):
        ways = {(p.method, p.change): p for p in of_kind}
        smoothed = ways[results.methods[0], AS_IS]
        text = (f"{kind_of(smoothed)}: {results.title(smoothed.method)} leaves {smoothed.error:.3f}{bracket(smoothed.error_interval, '.3f')} "
                f"of the error, for {smoothed.time:.2g}{bracket(smoothed.time_interval, '.2g')} times the time of one solution")
        for change, name, does in ((NEXT_DEGREE, "the next degree", f"degree {int(smoothed.degree) + 1} on the unsmoothed mesh leaves"),
                                   (SPLIT, "splitting", "splitting every cell of the unsmoothed mesh leaves")):
            other = ways.get((INITIAL_MESH, change))
            if other:
                text += f"; {does} {other.error:.3f} for {other.time:.2g} times: {verdict(smoothed, other, name)}"
        if math.isfinite(smoothed.at_equal_time):
            text += (f". After the same time in all its error is {smoothed.at_equal_time:.3f}{bracket(smoothed.at_equal_time_interval, '.3f')} "
                     "of that of the unsmoothed mesh")
        sentences.append(text + ".")
    return sentences


def verdict(smoothed, other, name):
    """Says whether smoothing or the alternative has the lower error in no more time."""
    if smoothed.error <= other.error and smoothed.time <= other.time:
        return "smoothing pays"
    if other.error <= smoothed.error and other.time <= smoothed.time:
        return f"{name} is better and cheaper"
    return f"{name} is better, and dearer" if other.error < smoothed.error else "smoothing is better, and dearer"


def what_orders(results, found):
    """Reports where smoothing changes the order of the error in the mesh size, on all families."""
    cases, n_cases = changed(found)
    if not n_cases:
        return []
    text = (f"Smoothing changes the order of the error in h in {len(cases)} of {n_cases} cases, a case being a type of elements, degree, level, "
            f"method and norm (on each family the interval of the change excludes 0 on the same side, and the change is above {LEAST_CHANGE:g})")
    told = []
    for (elements, degree, level, method, error), entries in cases.items():
        changes = ", ".join(f"{entry.family} {entry.change:+.2f}{bracket(entry.change_interval)}" for entry in entries)
        told.append(f"{kind_of(entries[0])}, {results.title(method)}, {ERRORS[error]}: {changes}")
    return [text + ("; elsewhere it changes the constant only, as far as these sizes show." if told else
                    ": it changes the constant only, as far as these sizes show.") + ("" if not told else " " + "; ".join(told) + ".")]


def what_got_worse(results, found):
    """Reports how often methods raise the error or have no valid result: each method with its worst kinds of meshes, then the methods
    for which there is nothing to report."""
    sentences = []
    for name, said, otherwise in (("failed", "has no valid result", "Valid results on all problems"),
                                  ("worse", "raises the error by more than 1 %", "Never an error more than 1 % higher")):
        never = []
        for method in results.methods:
            most = sorted((gain for gain in found if gain.method == method and getattr(gain, name) > 0), key=lambda gain: -getattr(gain, name))
            if most:
                sentences.append(f"{results.title(method)} {said} on " + ", ".join(
                    f"{percent(getattr(gain, name))} of the problems ({kind_of(gain).lower()})" for gain in most[:MOST_KINDS])
                    + (f", and less often on {counted(len(most) - MOST_KINDS, 'other kind', 'other kinds')} of meshes"
                       if len(most) > MOST_KINDS else "") + ".")
            else:
                never.append(results.title(method))
        if never and found:
            sentences.append(f"{otherwise}: {', '.join(never)}.")
    return sentences


def what_predicts(predictions):
    """Reports the quality with the highest correlation with the error, for each type of elements and degree."""
    sentences = []
    for elements, degree in sorted({(p.elements, p.degree) for p in predictions}):
        known = [p for p in predictions if (p.elements, p.degree, p.outcome) == (elements, degree, ERROR) and math.isfinite(p.mean)]
        if not known:
            continue
        best = max(known, key=lambda p: abs(p.mean))
        text = (f"{elements.capitalize()}, degree {degree}: rank correlation with the error {best.mean:.2f}{bracket(best.interval)} for "
                f"{symbol_of(best.quality).text}, the strongest of {len(known)}")
        own = next((p for p in known if p.quality == OWN_MEASURE and p is not best), None)
        if own:
            p_value = differ(best, own)
            told = ("they cannot be compared" if not math.isfinite(p_value) else
                    f"p = {p_value:.2g} for the difference, too small because the strongest was chosen")
            text += f"; {own.mean:.2f}{bracket(own.interval)} for {symbol_of(own.quality).text} ({told})"
        sentences.append(text + ".")
    return sentences
