# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the results folder of a collection: its members, and of their rows the columns that are used."""

import csv
import lzma
from dataclasses import dataclass
from operator import itemgetter
from pathlib import Path

import numpy as np

from .rows import SOLVING, ResultsError, Rows, entries, is_there, open_rows, order_of, read_provenance, read_rows
from .smoothing import INITIAL
from .solvers import solvers_of
from .symbols import of_solver

MEMBER_COLUMNS = ("member", "family", "elements", "solution", "status", "reason")
QUALITIES = ("q_min", "q_star_min", "q_mean")
OUTCOMES = ("l2_error", "h1_error", "condition_number", "cg_iterations")
# Of metrics.csv, and what its rows have in common with those of iterations.csv.
RECORD = ("member", "mesh", "method", "stage", "iteration")
STATISTICS = ("metric", "better", "min", "mean", "max")
# Of iterations.csv, which has many rows.
KEYS = ("member", "family", "elements", "distortion", "solution", "mesh", "method", "degree")
OPTIONAL = ("n_solves",)  # of methods that solve by themselves; results of earlier versions have no such column
# Of refined.csv.
REFINED = ("member", "method", "degree", *SOLVING, "h1_error")
# Of summary.csv.
SUMMARY = ("member", "elements", "solution", "method", "degree", "smoothing_seconds", "preparation_seconds", *SOLVING, "n_invalid",
           "q_min", "q_mean", "l2_error", "h1_error")
NUMBERS = ("smoothing_seconds", "preparation_seconds", *SOLVING, "n_invalid", *QUALITIES, *OUTCOMES)


@dataclass(frozen=True, eq=False)  # compared by identity, as computed values are cached
class CollectionResults:
    """One results folder."""

    folder: Path
    study: str
    study_title: str
    methods: tuple
    titles: dict
    members: Rows
    iterations: Rows  # KEYS, NUMBERS, and the columns of metrics and further solvers only
    refined: Rows = Rows(Path("refined.csv"), {})  # REFINED: initial and resulting meshes with every cell split
    summary: Rows = Rows(Path("summary.csv"), {})  # SUMMARY
    solving: frozenset = frozenset()  # methods that solve by themselves
    interpreted: frozenset = frozenset()  # methods in Python
    qualities: tuple = QUALITIES  # columns of iterations: what may predict an outcome; none if only ends were kept
    solvers: tuple = ()  # besides Poisson's

    def title(self, name):
        """The title of a method; its name where the provenance gives none."""
        return self.titles.get(name, name)


def read_some_columns(path, names, optional=()):
    """Some columns of a CSV file, which may be large; raises ResultsError if it is missing, truncated or lacks
    one of them. Optional ones are left out where they are not there. Those of further solvers are always read."""
    try:
        with open_rows(path) as stream:
            lines = csv.reader(stream)
            header = next(lines, [])
            missing = [name for name in names if name not in header]
            if missing:
                raise ResultsError(f"{path}: column `{missing[0]}` is missing.")
            names = (*names, *(name for name in header if name in optional or of_solver(name)[0]))
            chosen = itemgetter(*(header.index(name) for name in names))
            table = [chosen(line) for line in lines]
    except FileNotFoundError:
        raise ResultsError(f"{path}: the file is missing; has a member of the study been completed?") from None
    except (IndexError, EOFError, OSError, UnicodeDecodeError, csv.Error, lzma.LZMAError) as error:
        raise ResultsError(f"{path}: the file cannot be read ({error}); it looks truncated.") from None
    columns = zip(*table) if table else ([] for _ in names)
    return Rows(Path(path), {name: np.array(column, dtype=object) for name, column in zip(names, columns)})


def metric_columns(path, rows):
    """name -> column for the rows of iterations.csv: of each metric the mean and the worst number of the same mesh."""
    metrics = read_some_columns(path, (*RECORD, *STATISTICS))
    records = {}  # those of several degrees are one
    record_of_row = np.array([records.setdefault(key, len(records)) for key in zip(*(rows.text(name) for name in RECORD))])
    record_of_line = np.array([records.get(key, -1) for key in zip(*(metrics.text(name) for name in RECORD))])
    columns = {}
    for (metric, better), lines in numbers_of(zip(metrics.text("metric"), metrics.text("better"))):
        if metric == "mean_ratio":
            continue  # q_min and q_mean are these
        lines = lines[record_of_line[lines] >= 0]
        name = metric.replace("_", " ")
        for column, statistic in ((f"mean {name}", "mean"), (f"worst {name}", "min" if better == "larger" else "max")):
            of_records = np.full(len(records), "", dtype=object)
            of_records[record_of_line[lines]] = metrics.text(statistic)[lines]
            columns[column] = of_records[record_of_row]
    return columns


def ends(summary):
    """What iterations.csv has at least of each method: the initial mesh and the result. For results whose iterations were not kept."""
    keys = list(zip(*(summary.text(name) for name in ("member", "degree"))))
    is_initial = summary.text("method") == INITIAL
    first = {keys[number]: number for number in np.flatnonzero(is_initial)}
    after = [number for number in np.flatnonzero(~is_initial) if keys[number] in first]
    rows = summary.where(np.array([(first[keys[number]], number) for number in after], dtype=int).reshape(-1))
    return Rows(summary.path, {**rows.columns, "method": np.repeat(summary.text("method")[after], 2)})


def numbers_of(keys):
    """(key, array of the places where it stands), in the order of their first."""
    found = {}
    for number, key in enumerate(keys):
        found.setdefault(key, []).append(number)
    return [(key, np.array(numbers)) for key, numbers in found.items()]


def read_collection_results(folder):
    """Reads the folder; raises ResultsError if a file is missing, truncated or lacks a column."""
    folder = Path(folder)
    provenance = read_provenance(folder / "provenance.json")
    study = str(provenance.get("study") or folder.resolve().name)
    members = read_rows(folder / "members.csv", MEMBER_COLUMNS)
    # A part of a collection may have no member that is complete, and then no such file.
    file, columns, of_metrics = folder / "iterations.csv", (*KEYS, *NUMBERS), {}
    if "complete" not in members.text("status"):
        iterations = Rows(file, {name: np.array([], dtype=object) for name in columns})
    elif is_there(folder / "metrics.csv"):
        iterations = read_some_columns(file, tuple(dict.fromkeys((*columns, *RECORD))), OPTIONAL)
        of_metrics = metric_columns(folder / "metrics.csv", iterations)
        iterations = Rows(file, {**iterations.columns, **of_metrics})
    elif is_there(file) or not is_there(folder / "summary.csv"):
        iterations = read_some_columns(file, columns, OPTIONAL)
    else:
        iterations = ends(read_some_columns(folder / "summary.csv", columns, OPTIONAL))
    split = folder / "refined.csv"
    refined = read_some_columns(split, REFINED) if is_there(split) else Rows(split, {})
    has_summary = is_there(folder / "summary.csv")
    summary = read_some_columns(folder / "summary.csv", SUMMARY) if has_summary else Rows(file, {})
    titles = {INITIAL: "Initial", **{entry["name"]: str(entry["title"]) for entry in entries(provenance, "methods")
                                     if entry.get("title")}}
    return CollectionResults(
        folder=folder, study=study, study_title=str(provenance.get("study_title") or study),
        methods=tuple(name for name in order_of(iterations.text("method"), provenance, "methods") if name != INITIAL),
        titles=titles, members=members, iterations=iterations, refined=refined,
        summary=summary, solving=frozenset(iterations.text("method")[iterations.text("n_solves") != ""]),
        interpreted=frozenset(entry["name"] for entry in entries(provenance, "methods")
                              if str(entry.get("type", "")).startswith("python:")),
        qualities=(*QUALITIES, *of_metrics) if is_there(file) else (), solvers=solvers_of(summary if has_summary else iterations, provenance))
