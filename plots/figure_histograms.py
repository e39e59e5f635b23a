# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 6.7 of the thesis: how many cells of which quality each method's mesh has."""

import matplotlib.pyplot as pyplot
import numpy as np
from matplotlib.ticker import StrMethodFormatter

from .figure_history import FOOT, HEAD, INITIAL_DASHES, draw_legend, figure_size, method_order
from .read_results import INITIAL

BINS = 50


def draw_histograms(results, meshes, qualities, logarithmic=False):
    """A panel for each of the meshes with a stepped line for each method.

    `qualities` maps (mesh, method) to the mean ratios of all cells; what is missing has no line.
    """
    present = {method for _, method in qualities}
    styles = {name: look for name, look in method_order(results).items() if name in present}
    width, height = figure_size(1, len(meshes))
    height += 0.35
    figure, axes = pyplot.subplots(1, len(meshes), squeeze=False, figsize=(width, height))
    legend_height = draw_legend(figure, results, styles, markers=False)
    height += legend_height
    figure.set_figheight(height)
    figure.subplots_adjust(left=0.68 / width, right=1 - 0.1 / width, bottom=FOOT / height,
                           top=1 - (HEAD + legend_height) / height,
                           wspace=0.62 * len(meshes) / width)
    for ax, mesh in zip(axes[0], meshes):
        for method, look in styles.items():
            if (mesh, method) in qualities:
                draw_steps(ax, qualities[mesh, method], look.colour,
                           INITIAL_DASHES if method == INITIAL else look.dashes)
        ax.set(xlim=(0, 1), xlabel="Mean ratio quality number $q$", title=results.title(mesh))
        ax.yaxis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
        if logarithmic:
            ax.set_yscale("log")
            ax.set_ylim(bottom=0.7)
        else:
            ax.set_ylim(bottom=0)
    axes[0][0].set_ylabel("Number of cells")
    return figure


def draw_steps(ax, values, colour, dashes):
    """The outline of one histogram; invalid cells, whose mean ratio may be negative, count as 0."""
    counts, edges = np.histogram(np.clip(values, 0, 1), BINS, (0, 1))
    line = ax.stairs(counts, edges, color=colour, linewidth=1.0, baseline=None)
    if dashes:
        line.set_linestyle((0, dashes))
