# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 6.4 of the thesis: mesh quality and solution errors against smoothing time."""

import matplotlib.pyplot as pyplot
import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from ..results.smoothing import INITIAL
from ..results.symbols import SYMBOLS
from .diagrams import (FOOT, HEAD, INITIAL_DASHES, MARKER_SIZE, draw_legend, figure_size,
                       styles_in_order, thin_markers)

# Of the mesh, hence the same for every degree; numbers that lie between 0 and 1 have linear axes.
QUALITY = ("q_min", "q_star_min", "q_mean", "w_mean")
LINEAR = ("q_min", "q_star_min", "q_mean")

# A row of other panels is logarithmic from this ratio of largest to smallest number on: the thesis'
# own figure of errors spans a factor of 7 at most and is linear, errors of quadratic elements span
# more than 20.
LOGARITHMIC_FROM = 12.0

# One method that takes so many times as long as every other would squeeze all of them into a line:
# then a linear time axis ends at so many times the second longest time, and says when that one ends.
DOMINANT_FROM, SHOWN_OF_DOMINANT = 20.0, 5.0

LABEL_DISTANCE = 0.36  # inches from the axis to its label


def draw_history(results, columns, degree, log_time=False, meshes=None):
    """A figure with a row for each measure and a column for each mesh; None if there is no number.

    `columns` are columns of iterations.csv, `degree` a string as in the file; `meshes` are some of
    the study's, or None for all.
    """
    meshes = results.meshes if meshes is None else meshes
    lines = {(name, mesh): panel_lines(results, name, mesh, degree)
             for name in columns for mesh in meshes}
    columns = [name for name in columns
               if any(np.isfinite(v).any() for mesh in meshes
                      for _, v in lines[name, mesh].values())]
    if not columns:
        return None
    styles = styles_in_order(results)
    figure, axes = empty_panels(results, styles, len(columns), len(meshes))
    for letter, row, name in zip("abcdefghij", axes, columns):
        logarithmic = name not in LINEAR and any(
            spans_magnitudes(finite_values(lines[name, mesh])) for mesh in meshes)
        for ax, mesh in zip(row, meshes):
            dominant, limit = ("", np.inf) if log_time else dominant_method(lines[name, mesh])
            draw_panel(ax, lines[name, mesh], styles, log_time, limit)
            scale_values(ax, finite_values(lines[name, mesh]), logarithmic)
            if dominant:
                seconds, values = lines[name, mesh][dominant]
                annotate_free_area(ax, f"{results.title(dominant)} ends after {seconds[-1]:.3g} s "
                                          f"at {values[-1]:.3g}")
        row[0].set_ylabel(f"({letter})  {SYMBOLS[name].tex}"
                          + (f"  ($d={degree}$)" if name not in QUALITY else ""))
        # A fixed distance aligns the labels of all rows, whatever their ticks are.
        row[0].yaxis.set_label_coords(
            -LABEL_DISTANCE / (row[0].get_position().width * figure.get_figwidth()), 0.5)
    for ax, mesh in zip(axes[0], meshes):
        ax.set_title(results.title(mesh))
    for ax in axes[-1]:
        ax.set_xlabel("Smoothing time (s)")
    thin_markers(figure)
    return figure


def empty_panels(results, styles, n_rows, n_columns):
    """(figure, axes (n_rows, n_columns)) below a legend of the methods with these styles."""
    width, height = figure_size(n_rows, n_columns)
    figure, axes = pyplot.subplots(n_rows, n_columns, squeeze=False, sharex="col",
                                   figsize=(width, height))
    legend_height = draw_legend(figure, results, styles)
    height += legend_height
    figure.set_figheight(height)
    figure.subplots_adjust(left=0.6 / width, right=1 - 0.1 / width, bottom=FOOT / height,
                           top=1 - (HEAD + legend_height) / height, hspace=0.1,
                           wspace=0.52 * n_columns / width)
    return figure, axes


def panel_lines(results, name, mesh, degree):
    """What one panel shows: method -> (seconds, values), in the order of the iterations.

    Values are NaN, and the line has a gap, where the mesh is invalid or the file has no number.
    """
    rows = results.iterations.select(mesh=mesh)
    if name in QUALITY:  # the same for every degree
        degree = next((d for d in rows.text("degree")), degree)
    rows = rows.select(degree=degree)
    lines = {}
    for method in (*results.methods, INITIAL):
        chosen = rows.select(method=method)
        values = chosen.number(name)
        invalid = chosen.number("n_invalid") > 0
        if len(chosen):
            lines[method] = (chosen.number("smoothing_seconds"), np.where(invalid, np.nan, values))
    return lines


def draw_panel(ax, lines, styles, log_time, limit):
    """The lines of all methods up to a time and a level line for the initial mesh."""
    for method, (seconds, values) in lines.items():
        look = styles[method]
        if method == INITIAL:
            continue
        shown = seconds > 0 if log_time else seconds <= limit
        line, = ax.plot(seconds[shown], values[shown], color=look.colour, marker=look.marker,
                        markersize=MARKER_SIZE, markeredgewidth=0.4,
                        markerfacecolor=look.marker_fill, clip_on=True, label=method)
        if look.dashes:
            line.set_dashes(look.dashes)
    level = initial_level(lines)
    if np.isfinite(level):
        ax.axhline(level, color=styles[INITIAL].colour, linewidth=0.8, dashes=INITIAL_DASHES, zorder=1)
    if log_time:
        ax.set_xscale("log")
        ax.margins(x=0.02)
    else:
        last = max((seconds[-1] for seconds, _ in lines.values()), default=0.0)
        if last > 0:
            ax.set_xlim(-0.02 * min(last, limit), min(1.02 * last, limit))


def dominant_method(lines):
    """(method, time at which the axis ends) if one method takes far longer than all others; else no
    name and an infinite time."""
    ends = sorted((seconds[-1], method) for method, (seconds, _) in lines.items() if method != INITIAL)
    if len(ends) < 2 or not 0 < DOMINANT_FROM * ends[-2][0] < ends[-1][0]:
        return "", np.inf
    return ends[-1][1], SHOWN_OF_DOMINANT * ends[-2][0]


def annotate_free_area(ax, sentence):
    """Writes at the right of a panel at the height that is farthest from all lines there."""
    points = np.concatenate([line.get_transform().transform(line.get_xydata())
                             for line in ax.get_lines()])
    points = ax.transAxes.inverted().transform(points[np.isfinite(points).all(axis=1)])
    taken = points[points[:, 0] > 0.4, 1]
    height = max(np.linspace(0.1, 0.9, 9), key=lambda y: np.abs(taken - y).min(initial=1.0))
    ax.text(0.98, height, sentence, transform=ax.transAxes, ha="right", va="center",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1})


def initial_level(lines):
    """The value on the initial mesh: its own row, or iteration 0 of any method."""
    firsts = [lines[INITIAL][1]] if INITIAL in lines else [v for _, v in lines.values()]
    return next((v[0] for v in firsts if len(v)), np.nan)


def finite_values(lines):
    """All numbers that a panel shows."""
    values = np.concatenate([v for _, v in lines.values()] or [np.array([])])
    return values[np.isfinite(values)]


def spans_magnitudes(values):
    """Whether the values ask for a logarithmic axis."""
    return len(values) > 0 and values.min() > 0 and values.max() > LOGARITHMIC_FROM * values.min()


def scale_values(ax, values, logarithmic):
    """A logarithmic axis, or a linear one that starts at zero."""
    if not len(values):
        return
    high = values.max() if values.max() > 0 else 1.0
    if logarithmic and values.min() > 0:
        ax.set_yscale("log")
        label_logarithmic(ax, values.min(), values.max())
    else:
        # A small margin below: lowest qualities are often as good as zero and would lie on the axis.
        ax.set_ylim(min(0.0, values.min()) - 0.03 * high, 1.06 * high)


def label_logarithmic(ax, low, high):
    """Plain numbers instead of powers of ten where they are short, with 2 and 5 if the range is small."""
    if low < 1e-3 or high > 1e4:
        return
    plain = FuncFormatter(lambda value, _: f"{value:g}")
    ax.yaxis.set_major_formatter(plain)
    if high / low < 300:
        ax.yaxis.set_minor_locator(LogLocator(subs=(2, 5)))
        ax.yaxis.set_minor_formatter(plain)
        ax.tick_params(axis="y", which="minor", labelsize=8)
    else:
        ax.yaxis.set_minor_formatter(NullFormatter())
