# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds names that a user gives; for unknown names, the error names the nearest one."""

import difflib
import re
from fnmatch import fnmatchcase

from .rows import ResultsError
from .symbols import short_column, symbol_of

# What stands before the names of figures and tables: figure_6_4_history, table_5_11-5_12_smoothing.
PREFIX = re.compile(r"^(figure|table)_((\d+_\d+-?)+_)?")


def no_such_name(what, wanted, names, nearest=None):
    """The error for an unknown name, in the words of the program. nearest: one of the names (default: found here)."""
    if not names:
        return ResultsError(f"there is no {what} '{wanted}'; none is available.")
    nearest = nearest or next(iter(difflib.get_close_matches(wanted, names, 1)), None)
    question = f"did you mean '{nearest}'? " if nearest else ""
    return ResultsError(f"there is no {what} '{wanted}'; {question}choose one of {', '.join(names)}.")


def find_column(wanted, columns, numbers):
    """The column of that name, or of that heading: `cond(A)` and `cond` are `condition_number`, `H1` is `h1_error`. Case
    does not matter. Raises ResultsError with the nearest name, of those in `numbers`."""
    if wanted in columns:
        return wanted
    headings = {}
    for column in numbers:
        text = symbol_of(column).text
        for heading in (text, re.sub(r"\s*\(.*?\)", "", text), text.removesuffix(" error"), short_column(column)):
            headings.setdefault(heading.casefold(), column)
    headings.update((name.casefold(), name) for name in columns)
    known = wanted.casefold()
    if known in headings:
        return headings[known]
    raise no_such_name("column", wanted, numbers, nearest_column(known, headings))


def nearest_column(wanted, called):
    """The column with the nearest name; None if none is near. A true error comes before a norm of the thesis, unless the
    name begins like one."""
    for norm, error in (("h1", "h1_error"), ("l2", "l2_error")):
        if norm in wanted and not wanted.startswith("e") and error in called:
            return error
    nearest = difflib.get_close_matches(wanted, called, 1)
    return called[nearest[0]] if nearest else None


def find_all(what, wanted, names, titles=None):
    """The wanted names in the order of `names`; all of them if none is wanted. A title that only one of them has stands for
    its name. Raises ResultsError for one that is not among them."""
    by_title = {}
    for name in names:
        by_title.setdefault((titles or {}).get(name, name).casefold(), []).append(name)
    found = set()
    for name in wanted:
        of_title = by_title.get(name.casefold(), [])
        if name not in names and len(of_title) != 1:
            raise no_such_name(what, name, names)
        found.add(name if name in names else of_title[0])
    return tuple(name for name in names if name in found or not wanted)


def short_name(name):
    """The name of a figure or table without its number: history."""
    return PREFIX.sub("", name)


def select(patterns, names):
    """All names of figures and tables that patterns such as `*history*` mean, with or without their
    numbers; raises ResultsError for a pattern that means none. `names` maps each name to another one by
    which it is called, too, or to an empty string."""
    found = set()
    for pattern in patterns:
        matches = [name for name, other in names.items() if any(
            fnmatchcase(called, pattern) for called in (name, short_name(name), other, short_name(other)))]
        if not matches:
            raise no_such_name("figure or table", pattern, list(dict.fromkeys(map(short_name, names))))
        found.update(matches)
    return found
