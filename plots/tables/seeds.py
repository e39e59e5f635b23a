# SPDX-License-Identifier: GPL-3.0-or-later
"""Influence of chance: median and range, over the seeds of a study, of the numbers of its other tables."""

import math
import statistics

from ..results.rows import ResultsError
from .descriptions import ERRORS, KEY_HEADINGS, SMOOTHING, SOLVER
from .smoothing import first_degree, has_what_it_needs, in_study_order, key_cells, key_of
from .table import Group, Table, number_cell

SUBHEADINGS = ("median", "least", "greatest")


def make_seed_tables(results):
    """A table for each of smoothing, solver and errors; empty for studies of one seed."""
    if not results.repeated:
        return []
    tables = [seed_table(description, results) for description in (SMOOTHING, SOLVER, ERRORS)]
    return [table for table in tables if table is not None]


def seed_table(description, results):
    """One table, or None if the study has no rows or no numbers for it."""
    of_seeds = [{key_of(row, description.keys): row for row in rows_of(description, each, results.repeated)}
                for each in (results, *results.repetitions)]
    rows = in_study_order(list(of_seeds[0].values()), description.keys, results)
    if not rows or not has_what_it_needs(description, rows):
        return None
    keys = [key_of(row, description.keys) for row in rows]
    if any(set(found) != set(of_seeds[0]) for found in of_seeds):
        raise ResultsError(f"{results.summary.path}: not every seed has the same meshes and methods; "
                           "run the study again.")
    groups = [seed_group(measure, [[found[key].get(measure.column, "") for key in keys] for found in of_seeds])
              for measure in description.measures if measure.format and not measure.only_if_printed
              and (results.thesis_study or not measure.of_thesis)]
    groups = tuple(group for group in groups if group is not None)
    if not groups:
        return None
    cells, rules = key_cells(rows, description.keys, results)
    seeds = ", ".join(str(seed) for seed in results.seeds)
    return Table(study=results.study, name=f"table_seeds_{description.content}",
                 caption=f"{results.study_title}: {description.caption}, over {len(results.seeds)} seeds",
                 key_headings=tuple(KEY_HEADINGS[key] for key in description.keys), keys=cells, rules=rules,
                 left_aligned=(), groups=groups,
                 notes=(("", f"Median, smallest and largest number over the seeds {seeds} of generation and "
                             "distortion; the other tables and the figures show the first of them. A dash: "
                             "at least one seed has no number there."),))


def rows_of(description, results, meshes):
    """The rows of some meshes."""
    rows = [row for row in results.summary.records() if row["mesh"] in meshes]
    if description.degree_independent:
        rows = [row for row in rows if row.get("degree", "") == first_degree(row, rows)]
    return rows


def seed_group(measure, fields):
    """The columns of one measure; `fields`: of each seed, those of all rows. None if there is nothing in
    them worth showing."""
    if all(field in ("", *measure.unremarkable) for of_seed in fields for field in of_seed):
        return None
    rows = list(zip(*(measure.numbers(of_seed)[0] for of_seed in fields)))
    # Formatted together: as many digits in each of the three.
    texts = iter(measure.format([number for row in rows for number in median_and_range(row)]))
    return Group(measure.heading, SUBHEADINGS,
                 tuple(tuple(number_cell(next(texts)) for _ in SUBHEADINGS) for _ in rows))


def median_and_range(numbers):
    """Median, smallest and largest of some numbers; NaN if one of them is NaN."""
    if any(math.isnan(number) for number in numbers):
        return math.nan, math.nan, math.nan
    return statistics.median(numbers), min(numbers), max(numbers)
