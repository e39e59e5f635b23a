# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables that are written down column by column, and their cells."""

import math

from ..results.symbols import Heading
from .number_format import MISSING
from .table import Group, Table, number_cell, text_cell


def number(value, form=".2f"):
    """Returns the cell of a number; a dash if it is missing."""
    return number_cell(format(value, form) if math.isfinite(value) else MISSING)


def between(low_high, form=".2f"):
    """A cell of an interval."""
    low, high = low_high
    return text_cell(f"{low:{form}} to {high:{form}}" if math.isfinite(low) else MISSING)


def table_of(results, name, caption, keys, groups, notes):
    """keys: (heading, cells) columns that say what a row is about. groups: (heading, [(subheading, cells)])."""
    return Table(
        study=results.study, name=name, caption=f"{results.study_title}: {caption}",
        key_headings=tuple(heading if isinstance(heading, Heading) else Heading(heading, heading) for heading, _ in keys),
        keys=tuple(zip(*(cells for _, cells in keys))), rules=(), left_aligned=(),
        groups=tuple(Group(heading if isinstance(heading, Heading) else Heading(heading, heading),
                           tuple(sub for sub, _ in columns), tuple(zip(*(cells for _, cells in columns))))
                     for heading, columns in groups),
        notes=tuple(("", sentence) for sentence in notes))
