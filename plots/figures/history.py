# SPDX-License-Identifier: GPL-3.0-or-later
"""Histories: mesh quality and solution errors against smoothing time, as in Figure 6.4 of the thesis."""

import string
import textwrap

import matplotlib.pyplot as pyplot
import numpy as np
from matplotlib.lines import Line2D

from ..results.request import TIME
from ..results.smoothing import INITIAL
from ..results.symbols import THESIS_NORMS, of_solver, symbol_of
from .diagrams import (FOOT, HEAD, INITIAL_DASHES, MARKER_SIZE, draw_legend, figure_size,
                       styles_in_order, thin_markers)
from .history_lines import COUNTS, depends_on_degree, panel_lines, range_of
from .scales import make_room_for_labels, scale_values, space_ticks, spans_magnitudes

# Numbers that lie between 0 and 1 have linear axes.
LINEAR = ("q_min", "q_star_min", "q_mean")

# Around the record of the resulting mesh, and where a method's meshes begin to be invalid.
RESULT = {"marker": "o", "markersize": 7.0, "markerfacecolor": "none", "markeredgewidth": 0.8}
INVALID = {"marker": "x", "markersize": 5.5, "markeredgewidth": 1.4}
# Across records that are invalid, from the last valid mesh to the next one: no number is known there.
GAP = {"linewidth": 0.8, "linestyle": (0, (1, 1.6)), "marker": "x", "markersize": 3.6, "markeredgewidth": 0.7}
TITLE_LINE, NO_TITLE = 0.15, 0.06  # inches
# Sizes of sentences in a panel or above it, to place them next to the lines.
LETTERS_OF_AN_INCH, POINTS_OF_A_SEGMENT = 15, 20
LONGEST_LABEL = 20  # letters of a vertical axis that has degree and scale on the same line


def draw_history(results, columns, degree, log_x=False, meshes=None, x=TIME, log_y=False, x_range=(None, None),
                 y_range=(None, None)):
    """A figure with a row for each measure and a column for each mesh; None if there is no number.

    `columns` and `x` are columns of iterations.csv, `degree` a string as in the file; `meshes` are
    some of the study's, or None for all. Vertical axes are logarithmic where their numbers span
    magnitudes, with `log_y` all of them. Ranges are (from, to), None where the numbers decide.
    """
    meshes = results.meshes if meshes is None else meshes
    lines = {(name, mesh): panel_lines(results, name, mesh, degree, x)
             for name in columns for mesh in meshes}
    columns = [name for name in columns
               if any(line.shown.any() for mesh in meshes for line in lines[name, mesh].values())]
    if not columns:
        return None
    ranges = [range_of([lines[name, mesh] for name in columns], log_x, x).limited(x_range) for mesh in meshes]
    styles = styles_in_order(results)
    is_single = len(columns) * len(meshes) == 1  # then the caption says what it shows
    figure, axes = empty_panels(results, styles, [[lines[name, mesh] for mesh in meshes] for name in columns],
                                ["" if is_single else results.title(mesh) + solver_in_title(results, columns) for mesh in meshes])
    for row, name in zip(axes, columns):
        values = [shown_values(lines[name, mesh], extent) for mesh, extent in zip(meshes, ranges)]
        logarithmic = log_y or name not in LINEAR and any(map(spans_magnitudes, values))
        for ax, mesh, extent, shown in zip(row, meshes, ranges, values):
            draw_panel(ax, lines[name, mesh], styles, extent)
            scale_values(ax, shown, logarithmic, y_range)
            bridge_gaps(ax, lines[name, mesh], styles, extent)
    units = {name: unit for solver in results.solvers for name, (unit, _) in solver.described.items() if unit}
    label_axes(figure, axes, {name: degree if depends_on_degree(results, name) else "" for name in columns}, units, x, ranges)
    for ax in axes[-1]:
        space_ticks(ax, whole=x in COUNTS)
    for row, name in zip(axes, columns):
        for ax, mesh, extent in zip(row, meshes, ranges):
            annotate_free_area(ax, words_on(results, lines[name, mesh], extent))
    thin_markers(figure)
    return figure


def only_solver(columns):
    """The label of the solver that has all columns; empty if there is none."""
    labels = {of_solver(name)[0] for name in columns}
    return labels.pop() if len(labels) == 1 else ""


def solver_in_title(results, columns):
    """" – Title" of the solver that has all columns; then its label is in no name of an axis."""
    label = only_solver(columns)
    return "".join(f" – {solver.title}" for solver in results.solvers if label and solver.label == label)


def empty_panels(results, styles, lines, titles):
    """(figure, axes) for rows of panels with these lines below titles, and a legend of the methods with
    these styles. It calls those invalid that are so on all meshes; others stand below the titles."""
    n_rows, n_columns = len(lines), len(titles)
    width, height = figure_size(n_rows, n_columns)
    figure, axes = pyplot.subplots(n_rows, n_columns, squeeze=False, sharex="col",
                                   figsize=(width, height))
    never = [{method for method, line in panel.items() if line.is_never_valid} for panel in lines[0]]
    everywhere = set.intersection(*never)
    elsewhere = [[results.title(method) for method in results.methods if method in methods - everywhere]
                 for methods in never]
    every = [line for row in lines for panel in row for method, line in panel.items() if method != INITIAL]
    marks = [(RESULT, "Result", any(line.result is not None for line in every)),
             (GAP, "Invalid meshes", any(line.gaps for line in every)),
             (INVALID, "Invalid from here", any(line.invalid_after is not None for line in every))]
    legend_height = draw_legend(figure, results, styles, remarks=dict.fromkeys(everywhere, "invalid"), more=[
        Line2D([], [], color="0.25", label=label, **{"linestyle": "none", **look})
        for look, label, occurs in marks if occurs])
    letters = int(LETTERS_OF_AN_INCH * width / n_columns)
    titles = ["\n".join([title, *(textwrap.wrap("invalid: " + ", ".join(methods), letters) if methods else [])])
              for title, methods in zip(titles, elsewhere)]
    head = legend_height + (HEAD + TITLE_LINE * max(title.count("\n") for title in titles) if any(titles) else NO_TITLE)
    height += head - HEAD
    figure.set_figheight(height)
    figure.subplots_adjust(bottom=FOOT / height, top=1 - head / height, hspace=0.1)
    for ax, title in zip(axes[0], titles):
        ax.set_title(title)
    return figure, axes


def label_axes(figure, axes, columns, units, x, ranges):
    """Names of the axes, and room for them. columns: each with its degree; empty: it has none. units: of columns whose headings have
    none."""
    # The titles above the panels name a single solver.
    named_above = axes.size > 1 and only_solver(columns)

    def short(column):
        return of_solver(column)[1] if named_above and column in columns else column

    def name_of(column):
        return label_of(short(column)) + (f" [{units[column]}]" if column in units else "")
    for letter, row, (name, degree) in zip(string.ascii_lowercase, axes, columns.items()):
        words = [*([f"$d={degree}$"] if degree else []),
                 *(["log"] if row[0].get_yscale() == "log" else [])]
        gap = "\n" if len(symbol_of(short(name)).text) > LONGEST_LABEL else "  "
        row[0].set_ylabel((f"({letter})  " if len(axes) > 1 else "") + name_of(name)
                          + (f"{gap}({', '.join(words)})" if words else ""))
    for ax, extent in zip(axes[-1], ranges):
        ax.set_xlabel(name_of(x) + (", log" if extent.logarithmic else "")
                      + ("" if extent.zero is None else "; 0 at the left edge"))
    make_room_for_labels(figure, axes)


def label_of(column):
    """The symbol of a column; norms of the thesis are called so, as they are not the true errors."""
    return ("thesis " if column in THESIS_NORMS else "") + symbol_of(column).tex


def bridge_gaps(ax, lines, styles, extent):
    """Dotted lines with crosses across records that are invalid, in a panel whose scales are known: without them, a gap
    looks like an error of the figure."""
    for method, line in lines.items():
        x = extent.placed(line.x)
        for before, gap, after in line.gaps:
            records = [before, *gap, after]
            if method == INITIAL or not extent.holds(x[records]).all():
                continue
            scale_x, scale_y = (np.log if axis == "log" else np.asarray for axis in (ax.get_xscale(), ax.get_yscale()))
            places, ends = scale_x(x[records]), scale_y(line.y[[before, after]])
            if not (np.isfinite(places).all() and np.isfinite(ends).all()):
                continue
            y = np.interp(places, places[[0, -1]], ends) if places[-1] > places[0] else np.linspace(*ends, len(places))
            y = np.exp(y) if ax.get_yscale() == "log" else y
            ax.plot(x[records], y, color=styles[method].colour, markevery=range(1, len(records) - 1), zorder=1.5,
                    label="_gap", **GAP)


def draw_panel(ax, lines, styles, extent):
    """The lines of all methods with their marks, and a level line for the initial mesh."""
    for method, line in lines.items():
        if method == INITIAL:
            continue
        look, x = styles[method], extent.placed(line.x)
        inside = extent.holds(x)
        # Also what lies beyond the axis: a line leads to the edge.
        drawn, = ax.plot(x, line.y, color=look.colour, marker=look.marker,
                         markersize=MARKER_SIZE, markeredgewidth=0.4,
                         markerfacecolor=look.marker_fill, label=method)
        if look.dashes:
            drawn.set_dashes(look.dashes)
        for record, mark in ((line.result, RESULT), (line.invalid_after, INVALID)):
            if record is not None and inside[record]:
                ax.plot(x[record], line.y[record], color=look.colour, linestyle="none", zorder=4, **mark)
    level = initial_level(lines)
    if np.isfinite(level):
        ax.axhline(level, color=styles[INITIAL].colour, linewidth=0.8, dashes=INITIAL_DASHES, zorder=1)
    if extent.logarithmic:
        ax.set_xscale("log", nonpositive="mask")
    ax.set_xlim(extent.low, extent.high)


def words_on(results, lines, extent):
    """Words on things that the axis does not show, such as the end of a method that runs beyond the axis."""
    line = lines.get(extent.dominant)
    if line is None or not line.shown.any():
        return []
    end = np.flatnonzero(line.shown)[-1]
    result = end if line.result is None or not line.shown[line.result] else line.result
    return [f"{results.title(extent.dominant)} ends after {line.x[end]:.3g} s; its result: {line.y[result]:.3g}"]


def annotate_free_area(ax, sentences):
    """Writes at the side and height of a panel that are farthest from all lines there."""
    if not sentences:
        return
    letters = int(LETTERS_OF_AN_INCH * ax.get_position().width * ax.figure.get_figwidth())
    words = ax.text(0.98, 0.5, "\n".join(textwrap.fill(sentence, letters) for sentence in sentences),
                    transform=ax.transAxes, ha="right", va="center", fontsize=8,
                    bbox={"facecolor": "white", "edgecolor": "none", "pad": 1})
    points = points_on_lines(ax)
    width = words.get_window_extent(ax.figure.canvas.get_renderer()).width / ax.bbox.width

    def distance(place):
        side, y = place
        low, high = (0.98 - width, 0.98) if side == "right" else (0.02, 0.02 + width)
        nearby = (points[:, 0] >= low) & (points[:, 0] <= high)
        return np.abs(points[nearby, 1] - y).min(initial=1.0)
    side, y = max(((side, y) for side in ("right", "left") for y in np.linspace(0.1, 0.9, 9)), key=distance)
    words.set(x=0.98 if side == "right" else 0.02, y=y, ha=side)


def points_on_lines(ax):
    """Many points on all lines of a panel, shape (n, 2), from (0, 0) at its lower left corner to (1, 1)."""
    found = [np.empty((0, 2))]
    for line in ax.get_lines():
        ends = ax.transAxes.inverted().transform(line.get_transform().transform(line.get_xydata()))
        steps = np.linspace(0, 1, POINTS_OF_A_SEGMENT)[:, None, None]
        found.append(((1 - steps) * ends[:-1] + steps * ends[1:]).reshape(-1, 2))
    points = np.concatenate(found)
    return points[np.isfinite(points).all(axis=1)]


def initial_level(lines):
    """The value on the initial mesh: its own row, or iteration 0 of any method."""
    firsts = [lines[INITIAL].y] if INITIAL in lines else [line.y for line in lines.values()]
    return next((y[0] for y in firsts if len(y)), np.nan)


def shown_values(lines, extent):
    """All numbers that a panel shows."""
    values = [line.y[line.shown & extent.holds(extent.placed(line.x))] for line in lines.values()]
    return np.concatenate(values) if values else np.array([])
