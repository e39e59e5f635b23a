# SPDX-License-Identifier: GPL-3.0-or-later
"""Fills the tables of Chapters 5 and 6 of the thesis: computed numbers, those of the thesis, their difference.

All tables have one mechanism; descriptions.py has their differences.
"""

from dataclasses import replace

from ..results.printed_values import comparison_notes
from ..results.rows import ResultsError
from ..results.smoothing import INITIAL
from ..results.symbols import SYMBOLS, THESIS_NORMS, Heading
from .descriptions import DETAILS, KEY_HEADINGS, MEANINGS, NORMS_MEANING, TABLES
from .method_order import order_notes
from .notes import Notes
from .number_format import BELOW_CLOCK, CLOCK, MISSING, format_seconds, relative_difference
from .sessions import times_sentence
from .table import Cell, Group, Table, escape_tex, heading_of, number_cell


COLUMNS_NOTE = ("Columns: the value of smoothfem, that of the thesis, and where it makes sense the relative difference "
                "in %. From ten times the value of the thesis on, the difference is a factor (=: equal in all printed "
                "digits).")
CLOCK_NOTE = f"{BELOW_CLOCK}: too short to be timed; no speedup is computed from such times."
TRUE_ERRORS = ("h1_error", "l2_error")
PROTOCOL_NOTE = ("Protocol of Chapter 6: f is interpolated at the nodes (`set load = nodal`). H1 and L2 error are the true errors of the solution of "
                 "this protocol; those with integrated f differ.")
INVALID = "invalid mesh"  # in the status of a mesh on which nothing is solved


def make_tables(results, printed):
    """All tables of a results folder; `printed` maps content to PrintedTable and may be empty."""
    tables = [make_table(description, results, printed.get(description.content))
              for description in TABLES]
    return [table for table in tables if table is not None]


def load_of(results):
    """How the load is computed: `quadrature` or `nodal`; empty if the provenance does not say."""
    problem = results.provenance.get("problem")
    return problem.get("load", "") if isinstance(problem, dict) else ""


def make_table(description, results, printed):
    """One table, or None if the study has no rows or no numbers for it."""
    rows = getattr(results, description.source).records()
    if description.degree_independent:
        rows = [row for row in rows if row.get("degree", "") == first_degree(row, rows)]
    if "error" in description.keys:
        rows = chosen_errors(rows, in_thesis=printed is not None)
    if not has_what_it_needs(description, rows):
        return None
    reference = printed.rows if printed else []
    rows, sentences = without_failures(rows, description.keys, results)
    if description is not DETAILS:
        sentences += invalid_meshes(rows, results)
    if description.pivot:
        rows = without_noise(rows)
        sentences += unreached(rows, results)
        description, rows, reference = pivot(description, rows, reference, results)
    rows = in_study_order(rows, description.keys, results)
    by_key = {}
    for row in reference:
        by_key.setdefault(key_of(row, description.keys), {}).update(row)
    pairs = [(row, by_key.get(key_of(row, description.keys), {})) for row in rows]
    in_thesis = any(printed_row for _, printed_row in pairs)
    compared = in_thesis and not results.is_quick
    pairs = pairs if compared else [(row, {}) for row, _ in pairs]
    notes = Notes(printed.deviations if printed and compared else [], pairs)
    detailed = has_what_it_needs(DETAILS, rows)
    groups = {measure: make_group(measure, pairs, notes, measure.only_if_printed or (measure.detail and detailed))
              for measure in description.measures if in_thesis or not measure.of_thesis}
    groups = {measure: group for measure, group in groups.items() if group is not None}
    if not rows or not groups:
        return None
    keys, rules = key_cells(rows, description.keys, results)
    name, caption = description.content, f"{results.study_title}: {description.caption}"
    sentences = meanings(description.keys, groups, rows) + sentences + notes.sentences()
    if any(measure.column in TRUE_ERRORS for measure in groups) and load_of(results) == "nodal":
        sentences += (("", PROTOCOL_NOTE),)
    if in_thesis:
        name = f"{printed.number.replace('.', '_')}_{name}"
        caption = f"Table {printed.number}: {caption}"
    if in_thesis and not compared:
        sentences += (("", f"Not compared with Table {printed.number} of the thesis: meshes of the scale `quick` are too coarse."),)
    if any(measure.format is format_seconds for measure in groups) and (sentence := times_sentence(results)):
        sentences += (("", sentence),)
    if compared:
        sentences = tuple(("", sentence) for sentence in (
            *comparison_notes(printed, results), COLUMNS_NOTE,
            *order_notes(description, pairs, results))) + sentences
    return Table(study=results.study, name=f"table_{name}", caption=caption, keys=keys, rules=rules,
                 groups=tuple(groups.values()),
                 key_headings=tuple(KEY_HEADINGS[key] for key in description.keys),
                 left_aligned=("Status", "cond(A) by"), notes=sentences)


def chosen_errors(rows, in_thesis):
    """The rows of the true errors; of the norms of the thesis where its table is compared, or where the results, of an
    earlier version, have no others."""
    of_norms = [row for row in rows if row["error"] in THESIS_NORMS]
    others = [row for row in rows if row["error"] not in THESIS_NORMS]
    return of_norms if in_thesis else others or of_norms


def has_what_it_needs(description, rows):
    """True if the rows have something in the column that the table depends on."""
    return not description.needs or any(row.get(description.needs) for row in rows)


def without_failures(rows, keys, results):
    """The rows, of which those of methods that failed are left with their keys only (their numbers are the
    initial mesh's), and a note for each failure."""
    left, sentences = [], {}
    for row in rows:
        status = results.failures.get((row["mesh"], row["method"])) if "status" in row else None
        if status:
            sentences[f"{results.title(row['method'])}, {results.title(row['mesh'])}: {status.rstrip('.')}."] = None
            row = {**{name: field for name, field in row.items() if name in keys}, "status": "failed"}
        left.append(row)
    return left, tuple(("", sentence) for sentence in sentences)


def invalid_meshes(rows, results):
    """A note for each method that ended with an invalid mesh: its numbers are dashes."""
    found = {}
    for row in rows:
        if INVALID in row.get("status", ""):
            cells = row.get("n_invalid", "")
            count = f" ({cells} cell{'' if cells == '1' else 's'})" if cells not in ("", "0") else ""
            found[f"{results.title(row['method'])}, {results.title(row['mesh'])}: the mesh is invalid{count}; nothing was solved "
                  "on it."] = None
    return tuple(("", sentence) for sentence in found)


def without_noise(rows):
    """The rows; those with a time that is too short for a quotient have no speedup."""
    def is_short(field):
        return bool(field) and float(field) < CLOCK
    return [{**row, "speedup": ""} if is_short(row["method_seconds"]) or is_short(row["reference_seconds"]) else row
            for row in rows]


def meanings(keys, groups, rows):
    """A note on what the headings mean, and one on times that are too short."""
    shown = list(dict.fromkeys(MEANINGS[measure.column] for measure in groups if measure.column in MEANINGS))
    shown += [NORMS_MEANING] if any(row.get("error") in THESIS_NORMS for row in rows) else []
    texts = {cell.text for measure, group in groups.items() if measure.format is format_seconds
             for row in group.cells for cell in row}
    return (*([("", "; ".join(shown) + ".")] if shown else []), *([("", CLOCK_NOTE)] if BELOW_CLOCK in texts else []))


def first_degree(row, rows):
    """The degree of the first row with the same mesh and method."""
    return next(other.get("degree", "") for other in rows
                if (other["mesh"], other["method"]) == (row["mesh"], row["method"]))


def key_of(row, keys):
    """The tuple by which computed and printed rows are matched."""
    return tuple(row.get(key, "") for key in keys)


def in_study_order(rows, keys, results):
    """The rows sorted by mesh, degree, then method as in the study (errors stay as they stand)."""
    orders = {"mesh": results.meshes, "degree": results.degrees, "error": tuple(SYMBOLS),
              "method": (INITIAL,) + results.methods}

    def position(row):
        return tuple(orders[key].index(row[key]) if row[key] in orders[key] else len(orders[key])
                     for key in keys)
    return sorted(rows, key=position)


def pivot(description, rows, reference, results):
    """Makes one row of the rows that differ in the method only: their columns become columns named
    `column method`, headed by the method's title."""
    by_method = [m for m in description.measures if m.column in ("method_seconds", "speedup")]
    occurring = {row["method"] for row in rows}
    methods = [method for method in results.methods if method in occurring]
    references = list(dict.fromkeys(row["reference_method"] for row in rows))
    if len(references) > 1:
        raise ResultsError(f"{results.thresholds.path}: more than one reference_method.")

    def headed(measure, method, column):
        title = results.title(method)
        prefix = "Speedup " if measure.column == "speedup" else ""
        unit = "" if prefix else " (s)"
        return replace(measure, column=column, heading=Heading(prefix + title + unit,
                                                               prefix + escape_tex(title) + unit))
    measures = []
    for measure in description.measures:
        if measure.column == "reference_seconds" and references:
            measures.append(headed(measure, references[0], measure.column))
        elif measure not in by_method:
            measures.append(measure)
    measures += [headed(measure, method, f"{measure.column} {method}")
                 for method in methods for measure in by_method]

    def merged(records):
        found = {}
        for record in records:
            row = found.setdefault(key_of(record, description.keys), dict(record))
            row.update({f"{m.column} {record['method']}": record[m.column] for m in by_method})
        return list(found.values())
    return replace(description, measures=tuple(measures)), merged(rows), merged(reference)


def unreached(rows, results):
    """A note that names the methods that reached none of the thresholds; they have no column."""
    reached = {row["method"] for row in rows if row["method_seconds"]}
    never = [m for m in results.methods if m not in reached and any(m == r["method"] for r in rows)]
    names = ", ".join(results.title(method) for method in never)
    return (("", f"No threshold was reached by: {names}."),) if never else ()


def make_group(measure, pairs, notes, only_if_printed):
    """The columns of one measure, or None if they have nothing worth showing; with `only_if_printed` also if the thesis
    prints no value."""
    fields = [computed.get(measure.column, "") for computed, _ in pairs]
    # None: the thesis has no such row or column; empty: it leaves the field empty.
    prints = [printed.get(measure.column) for _, printed in pairs]
    if not any(prints) and (only_if_printed or all(field in ("", *measure.unremarkable) for field in fields)):
        return None
    values, texts = measure.numbers(fields)
    columns, subheadings = [[number_cell(text) for text in texts]], ["smoothfem"]
    if any(prints):
        marks = ["" if printed is None else notes.letter(measure.column, row)
                 for row, printed in enumerate(prints)]
        columns.append([number_cell(printed or MISSING, mark) for printed, mark in zip(prints, marks)])
        subheadings.append("thesis")
        if measure.difference and values is not None:
            columns.append([number_cell(relative_difference(value, printed or ""))
                            for value, printed in zip(values, prints)])
            subheadings.append("%")
    else:
        subheadings = [""]
    return Group(measure.heading, tuple(subheadings), tuple(zip(*columns)), measure.tied)


def key_cells(rows, keys, results):
    """The leading cells of each row, blank where they repeat the row above, and where rules go."""
    cells, rules, above = [], [], None
    for number, row in enumerate(rows):
        key = key_of(row, keys)
        shown = [above is None or key[:i + 1] != above[:i + 1] for i in range(len(keys))]
        if above is not None and any(shown[:-1]):
            rules.append(number)
        cells.append(tuple(key_cell(name, row[name], results) if show else Cell("")
                           for name, show in zip(keys, shown)))
        above = key
    return tuple(cells), tuple(rules)


def key_cell(name, value, results):
    """The cell of a key: titles for methods, symbols for errors; meshes keep their short names."""
    if name == "error":
        heading = heading_of(value)
        return Cell(heading.text, tex=heading.tex)
    title = results.title(value) if name == "method" else value
    return Cell(title, tex=escape_tex(title))
