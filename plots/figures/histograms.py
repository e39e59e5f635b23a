# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 6.7 and 5.33 of the thesis: how many cells of which quality each method's mesh has, and how
that differs between a distorted mesh and the same mesh without distortion."""

import matplotlib.pyplot as pyplot
import numpy as np
from matplotlib.ticker import StrMethodFormatter

from ..results.smoothing import INITIAL
from .diagrams import (FOOT, HEAD, INITIAL_DASHES, MARKER_SIZE, draw_legend, figure_size,
                       styles_in_order)
from .scales import make_room_for_labels, spans_magnitudes

BINS = 50
# The thesis says of Fig. 5.33 at which qualities the differences are largest: 0.72, 0.92 and 0.98,
# which are middles of thirtieths.
DIFFERENCE_BINS = 30
LEAST_DIFFERENCE = 10.0  # on an axis that is logarithmic on both sides of zero: linear below


def draw_histograms(results, meshes, qualities, logarithmic=False):
    """A panel for each of the meshes with a stepped line for each method.

    `qualities` maps (mesh, method) to the mean ratios of all cells; a missing entry has no line.
    """
    figure, axes, styles = panels(results, meshes, qualities, markers=False)
    for ax, mesh in zip(axes, meshes):
        for method, look in styles.items():
            if (mesh, method) in qualities:
                draw_steps(ax, qualities[mesh, method], look.colour, dashes_of(method, look))
        if logarithmic:
            ax.set_yscale("log")
            ax.set_ylim(bottom=0.7)
        else:
            ax.set_ylim(bottom=0)
    axes[0].set_ylabel("Number of cells")
    make_room_for_labels(figure, axes[None, :])
    return figure


def draw_histogram_differences(results, pairs, qualities):
    """A panel for each of the `pairs` (mesh, distorted mesh) with a line for each method: numbers of
    cells of its result on the distorted mesh minus those on the other. `qualities` as above."""
    figure, axes, styles = panels(results, [mesh for mesh, _ in pairs], qualities, markers=True)
    middles = (np.arange(DIFFERENCE_BINS) + 0.5) / DIFFERENCE_BINS
    for ax, (mesh, distorted) in zip(axes, pairs):
        ax.axhline(0, color="0.6", linewidth=0.6)
        differences = {method: counts_of(qualities[distorted, method], DIFFERENCE_BINS)
                       - counts_of(qualities[mesh, method], DIFFERENCE_BINS) for method in styles
                       if qualities.keys() >= {(mesh, method), (distorted, method)}}
        for method, values in differences.items():
            look = styles[method]
            line, = ax.plot(middles, values, color=look.colour, marker=look.marker,
                            markersize=MARKER_SIZE, markeredgewidth=0.4, linewidth=0.8,
                            markerfacecolor=look.marker_fill, label=method)
            if dashes_of(method, look):
                line.set_dashes(dashes_of(method, look))
        largest = [np.abs(values).max() for values in differences.values() if values.any()]
        if spans_magnitudes(np.array(largest)):
            # On the scale of one method another would be a line on zero.
            ax.set_yscale("symlog", linthresh=LEAST_DIFFERENCE, linscale=0.5)
            ax.yaxis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
    axes[0].set_ylabel("Difference of numbers of cells")
    make_room_for_labels(figure, axes[None, :])
    return figure


def panels(results, meshes, qualities, markers):
    """(figure, axes, styles of the methods): empty panels side by side below a legend."""
    present = {method for _, method in qualities}
    styles = {name: look for name, look in styles_in_order(results).items() if name in present}
    width, height = figure_size(1, len(meshes))
    height += 0.35
    figure, axes = pyplot.subplots(1, len(meshes), squeeze=False, figsize=(width, height))
    legend_height = draw_legend(figure, results, styles, markers)
    height += legend_height
    figure.set_figheight(height)
    figure.subplots_adjust(bottom=FOOT / height, top=1 - (HEAD + legend_height) / height)
    for ax, mesh in zip(axes[0], meshes):
        ax.set(xlim=(0, 1), xlabel="Mean ratio quality number $q$", title=results.title(mesh))
        ax.yaxis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
    return figure, axes[0], styles


def dashes_of(method, look):
    """The dash pattern of a method's line; the initial mesh has a pattern of its own."""
    return INITIAL_DASHES if method == INITIAL else look.dashes


def counts_of(values, n_bins):
    """Counts the cells in each of equal parts of [0, 1]. Invalid cells, whose mean ratio may be negative, count as
    0."""
    return np.histogram(np.clip(values, 0, 1), n_bins, (0, 1))[0]


def draw_steps(ax, values, colour, dashes):
    """The outline of one histogram."""
    line = ax.stairs(counts_of(values, BINS), np.linspace(0, 1, BINS + 1), color=colour,
                     linewidth=1.0, baseline=None)
    if dashes:
        line.set_linestyle((0, dashes))
