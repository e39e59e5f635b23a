# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the order of the methods of a table with the printed order, mesh by mesh and number by number."""

import math
from collections import Counter
from dataclasses import dataclass
from itertools import combinations

from ..results.smoothing import INITIAL
from .number_format import grouped


@dataclass(frozen=True)
class Entry:
    """A number of one method: measured and printed, as values and as the table shows them."""

    method: str  # its title
    computed: float
    printed: float
    computed_shown: str
    printed_shown: str

    @property
    def shown(self):
        """Both as the table shows them."""
        return self.computed_shown, self.printed_shown


def order_notes(description, pairs, results):
    """Returns sentences on the order of the methods in a table, compared with the thesis.

    The first sentence states the agreement. Each case of another order adds a sentence with the numbers.

    `pairs` are (computed row, printed row or {}). Numbers that the table shows alike, computed or printed,
    have no order, and the mesh before smoothing is no method. Empty if the thesis does not
    print two methods to compare.
    """
    if "method" not in description.keys:
        return []
    compared, cases = [], {}
    for measure in description.measures:
        if measure.ranks_methods and measure.format is not None:
            found = {case: entries for case, entries
                     in entries_of(measure, description, pairs, results).items() if len(entries) > 1}
            compared += [measure.heading.text] if found else []
            for case, entries in found.items():
                cases.setdefault(case, []).append((measure.heading.text, entries))
    if not compared:
        return []
    exceptions = [f"• {case}, {name}: {sentence}" for case, numbers in cases.items()
                  for name, entries in numbers for sentence in disagreements(entries)]
    names = " and ".join(filter(None, (", ".join(compared[:-1]), compared[-1])))
    beginning = f"The order of the methods by {names} is that of the thesis"
    return [f"{beginning}, but for these:", *exceptions] if exceptions else [f"{beginning}."]


def entries_of(measure, description, pairs, results):
    """Name of a mesh (and degree) -> entries of the methods that have both numbers. A method
    with the displayed numbers of an earlier one, such as the same method on several threads, is left out."""
    values, texts = measure.numbers([computed.get(measure.column, "") for computed, _ in pairs])
    found = {}
    for (computed, printed), value, text in zip(pairs, values, texts):
        theirs = number_or_nan(printed.get(measure.column))
        if computed["method"] == INITIAL or math.isnan(value) or math.isnan(theirs):
            continue
        case = results.title(computed["mesh"])
        case += f", d = {computed['degree']}" if "degree" in description.keys else ""
        entry = Entry(results.title(computed["method"]), value, theirs, grouped(text),
                      grouped(printed[measure.column]))
        if all(entry.shown != other.shown for other in found.setdefault(case, [])):
            found[case].append(entry)
    return found


def number_or_nan(text):
    """The number in a field of the printed table, which may be absent, empty or a word."""
    try:
        return float(text)
    except (TypeError, ValueError):
        return math.nan


def computed_sign(one, other):
    """1 or -1 if the computed number of one method is above or below that of another, 0 if shown alike."""
    return 0 if one.computed_shown == other.computed_shown else 1 if one.computed > other.computed else -1


def printed_sign(one, other):
    """The sign for the printed numbers."""
    return (one.printed > other.printed) - (one.printed < other.printed)


def disagreements(entries):
    """Sentences on pairs whose order is not the printed one. The method
    with the most such pairs comes first, so that a single misplaced method takes one sentence."""
    wrong = [pair for pair in combinations(entries, 2) if computed_sign(*pair) * printed_sign(*pair) < 0]
    sentences = []
    while wrong:
        counts = Counter(entry for pair in wrong for entry in pair)
        misplaced = max(entries, key=lambda entry: counts[entry])
        others = [entry for entry in entries
                  if (entry, misplaced) in wrong or (misplaced, entry) in wrong]
        wrong = [pair for pair in wrong if misplaced not in pair]
        for side, computed, printed in ((1, ">", "<"), (-1, "<", ">")):
            partners = [other for other in others if computed_sign(misplaced, other) == side]
            if partners:
                named = ", ".join(f"{other.method} ({other.computed_shown})" for other in partners)
                numbers = ", ".join(other.printed_shown for other in partners)
                sentences.append(f"{misplaced.method} ({misplaced.computed_shown}) {computed} {named}; "
                                 f"thesis: {misplaced.printed_shown} {printed} {numbers}")
    return sentences
