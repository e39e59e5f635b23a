# SPDX-License-Identifier: GPL-3.0-or-later
"""Common parts of diagrams of several methods: sizes, a legend above them, markers."""

import math

import numpy as np
from matplotlib.lines import Line2D

from ..results.method_styles import method_styles
from ..results.smoothing import INITIAL
from . import style

# Inches: the titles of the columns, the time axis, and a row of panels with the gap below it.
HEAD, FOOT, PANEL_HEIGHT = 0.26, 0.4, 1.72
INITIAL_DASHES = (1, 2)
MARKER_SIZE = 2.8
# Of figures narrower than so many inches, in which a legend would take much of the height.
NARROW = 4.0
NARROW_LEGEND = {"columnspacing": 0.9, "handlelength": 2.3, "fontsize": 8, "labelspacing": 0.3}
USUAL_LEGEND = {"columnspacing": 1.2, "handlelength": 2.9}
MARKER_DISTANCE = 3.5  # points between the markers of one line that are drawn


def figure_size(n_rows, n_columns):
    """Width and height in inches, without the legend; up to three columns can be read."""
    width = style.full_width() if n_columns > 1 else style.width_of(1.3 * style.SINGLE_WIDTH)
    return width, HEAD + FOOT + PANEL_HEIGHT * n_rows


def styles_in_order(results):
    """Styles of the methods in the order of the study; the initial mesh has a line of its own."""
    styles = method_styles(results.study_methods or results.methods)
    return {method: styles[method] for method in (*results.methods, INITIAL)}


def draw_legend(figure, results, styles, markers=True, remarks=None, more=()):
    """Draws the legend of all panels, above them, in as few lines as fit; returns its height in inches. `remarks` maps
    methods to words behind their titles, `more` are handles of lines that do not belong to a method."""
    handles = []
    for method, look in styles.items():
        handle = Line2D([], [], color=look.colour, marker=(look.marker or None) if markers else None,
                        markersize=MARKER_SIZE + 0.8, markerfacecolor=look.marker_fill)
        title = "Initial mesh" if method == INITIAL else results.title(method)
        handle.set_label(f"{title} ({remarks[method]})" if method in (remarks or {}) else title)
        if method == INITIAL:
            handle.set_linewidth(0.8)
            handle.set_dashes(INITIAL_DASHES)
        elif look.dashes:
            handle.set_dashes(look.dashes)
        handles.append(handle)
    handles.extend(more)
    for n_lines in range(1, len(handles) + 1):
        per_line = math.ceil(len(handles) / n_lines)  # lines of about the same length
        legend = figure.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 1.0),
                               ncol=per_line, handletextpad=0.5, borderaxespad=0.1,
                               **(NARROW_LEGEND if figure.get_figwidth() < NARROW else USUAL_LEGEND))
        extent = legend.get_window_extent(figure.canvas.get_renderer())
        if extent.width <= 0.99 * figure.bbox.width or per_line == 1:
            return extent.height / figure.dpi
        legend.remove()
    return 0.0


def thin_markers(figure):
    """Leaves out markers that would touch the last one drawn; the lines keep all their points."""
    distance = MARKER_DISTANCE * figure.dpi / 72
    for ax in figure.axes:
        ax.get_xlim(), ax.get_ylim()  # asking brings the limits, hence transData, up to date
        for line in ax.get_lines():
            if line.get_marker() in ("", "None", None) or line.get_label() == "_gap":
                continue
            points = ax.transData.transform(line.get_xydata())
            kept, last = [], None
            for i, point in enumerate(points):
                if np.isfinite(point).all() and (last is None or np.hypot(*(point - last)) >= distance):
                    kept.append(i)
                    last = point
            finite = np.flatnonzero(np.isfinite(points).all(axis=1))
            if len(finite) and kept[-1] != finite[-1]:
                # The last iteration is always marked, for that the marker before it may go.
                near = len(kept) > 1 and np.hypot(*(points[finite[-1]] - points[kept[-1]])) < distance
                kept = (kept[:-1] if near else kept) + [finite[-1]]
            line.set_markevery([int(i) for i in kept])
