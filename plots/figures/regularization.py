# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables and figures of a regularization study: Figures 3.4 and 3.8 of the thesis, and the numbers in
its text."""

from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as pyplot
import numpy as np

from ..results.printed_values import THESIS_FOLDER
from ..results.smoothing import Rows, groups_of, read_provenance, read_rows
from ..tables.descriptions import Heading
from ..tables.number_format import MISSING, relative_difference
from ..tables.smoothing import Group, Table, number_cell
from . import style

COUNTS = ("element", "transformation", "start", "sigma", "n_elements", "n_regularized", "mean",
          "deviation", "least", "most")
# Markers and dash patterns; the colours are those of all figures.
ELEMENTS = {"tetrahedron": ("o", ()), "hexahedron": ("s", (5, 1.5)), "pyramid": ("^", (1.2, 1.2)),
            "prism": ("D", (5, 1.5, 1.2, 1.5))}
STARTS = {"arbitrary": "Arbitrary initial elements", "valid": "Valid initial elements"}
MOST_SHOWN = 50  # transformations; for small sigma their number has no bound
MARKED_EVERY = 10  # sigmas between the marks of the standard deviation


@dataclass(frozen=True)
class RegularizationResults:
    """One results folder."""

    folder: Path
    study_title: str
    counts: Rows
    validity: Rows


def read_regularization_results(folder):
    """Reads the folder; throws ResultsError if a file is missing, truncated or lacks a column."""
    folder = Path(folder)
    provenance = read_provenance(folder / "provenance.json")
    title = str(provenance.get("study_title") or folder.resolve().name)
    return RegularizationResults(
        folder, title, read_rows(folder / "regularization.csv", COUNTS),
        read_rows(folder / "validity.csv", ("element", "n_elements", "n_valid", "share")))


def whole(rows):
    """The rows of those sigmas that made all elements regular."""
    complete = rows.text("n_regularized") == rows.text("n_elements")
    return Rows(rows.path, {name: column[complete] for name, column in rows.columns.items()})


def least_mean(rows):
    """(sigma, mean) where the mean number of transformations is least; NaN where no sigma is whole."""
    rows = whole(rows)
    if not len(rows):
        return float("nan"), float("nan")
    best = int(np.argmin(rows.number("mean")))
    return rows.number("sigma")[best], rows.number("mean")[best]


def printed_numbers():
    """(quantity, element, transformation, start) -> the number as printed."""
    rows = read_rows(THESIS_FOLDER / "chapter_3.csv",
                     ("quantity", "element", "transformation", "start", "printed")).records()
    return {(r["quantity"], r["element"], r["transformation"], r["start"]): r["printed"] for r in rows}


def compared(heading, texts, printed):
    """A group of our numbers, the printed ones and their difference; without print our numbers."""
    if not any(printed):
        return Group(Heading(heading, heading), ("",), tuple((number_cell(t),) for t in texts))
    return Group(Heading(heading, heading), ("ours", "printed", "%"), tuple(
        (number_cell(ours), number_cell(theirs or MISSING),
         number_cell(relative_difference(float(ours), theirs or "")))
        for ours, theirs in zip(texts, printed)))


def make_regularization_tables(results):
    """The fastest sigma of each series, and the shares of valid elements."""
    printed = printed_numbers()
    series = groups_of(results.counts, "element", "transformation", "start")
    least = [least_mean(rows) for _, rows in series]
    at_two = [rows.number("mean")[-1] for _, rows in series]
    fastest = Table(
        name="table_fastest", caption=f"{results.study_title}: sigma with the fewest transformations",
        key_headings=tuple(Heading(n, n) for n in ("Element", "Transformation", "Start")),
        keys=tuple(tuple(number_cell(text) for text in key) for key, _ in series), rules=(),
        left_aligned=(),
        groups=(compared("Sigma", [f"{sigma:.2f}" for sigma, _ in least],
                         [printed.get(("sigma", *key)) for key, _ in series]),
                compared("Mean number", [f"{mean:.2f}" for _, mean in least],
                         [printed.get(("mean", *key)) for key, _ in series]),
                compared("Mean number at the largest sigma", [f"{mean:.2f}" for mean in at_two],
                         [None] * len(series))),
        notes=(("", "Transformations until the mean ratio is at least 1 - tolerance; least mean over the "
                    "sigmas that made every element regular. The thesis does not say what its printed "
                    "number started from; it is the one for valid elements."),))
    elements = list(results.validity.text("element"))
    shares = Table(
        name="table_valid", caption=f"{results.study_title}: valid ones among random elements (%)",
        key_headings=(Heading("Element", "Element"),),
        keys=tuple((number_cell(element),) for element in elements), rules=(), left_aligned=(),
        groups=(compared("Valid", [f"{100 * share:.2f}" for share in results.validity.number("share")],
                         [printed.get(("valid", element, "", "")) for element in elements]),),
        notes=(("", "Nodes uniform in [-1, 1]^3. Both are random samples: with 100,000 elements the share "
                    "of 50 % has a standard deviation of 0.16."),))
    return [fastest, shares]


def draw_corridor(results):
    """Figure 3.4: least, mean and most transformations of tetrahedra by opposite face normals."""
    rows = whole(results.counts.select(element="tetrahedron", transformation="opposite-face-normals",
                                       start="valid"))
    figure, ax = pyplot.subplots(figsize=(style.SINGLE_WIDTH * 1.3, 2.6), constrained_layout=True)
    sigma = rows.number("sigma")
    ax.fill_between(sigma, rows.number("least"), rows.number("most"), color="0.85", linewidth=0,
                    label="least to most")
    ax.plot(sigma, rows.number("mean"), color=style.ELEMENT_COLOURS["tetrahedron"], label="mean")
    set_axes(ax)
    ax.legend(loc="upper right")
    return figure


def draw_speeds(results):
    """Figure 3.8: mean transformations of each element type, with standard deviations."""
    figure, axes = pyplot.subplots(1, len(STARTS), figsize=(style.FULL_WIDTH, 2.8), sharey=True,
                                   constrained_layout=True)
    for ax, (start, title) in zip(axes, STARTS.items()):
        for element, (marker, dashes) in ELEMENTS.items():
            colour = style.ELEMENT_COLOURS[element]
            rows = whole(results.counts.select(element=element, transformation="dual-element", start=start))
            sigma, mean = rows.number("sigma"), rows.number("mean")
            line, = ax.plot(sigma, mean, color=colour, label=element.capitalize())
            if dashes:
                line.set_dashes(dashes)
            ax.errorbar(sigma[::MARKED_EVERY], mean[::MARKED_EVERY],
                        rows.number("deviation")[::MARKED_EVERY], fmt=marker, color=colour,
                        markersize=2.8, elinewidth=0.7, capsize=1.6, capthick=0.7)
        set_axes(ax)
        ax.set_title(title)
    axes[0].legend(loc="upper right")
    axes[1].set_ylabel("")
    return figure


def set_axes(ax):
    """Labels and limits."""
    ax.set(xlabel=r"Scaling factor $\sigma$", ylabel="Transformations", ylim=(0, MOST_SHOWN))
    ax.margins(x=0.02)


FIGURES = {"figure_3_4_corridor": ("opposite face normals", draw_corridor),
           "figure_3_8_speeds": ("dual element transformation", draw_speeds)}


def draw_regularization_figures(results):
    """Draws all figures into <folder>/figures; returns the paths."""
    style.apply_style()
    return [path for name, (title, draw) in FIGURES.items()
            for path in style.save_figure(draw(results), results.folder / "figures", name,
                                          f"{results.study_title}: {title}")]
