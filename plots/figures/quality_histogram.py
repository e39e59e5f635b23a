# SPDX-License-Identifier: GPL-3.0-or-later
"""A histogram of the mean ratios of one mesh."""

from pathlib import Path

from matplotlib.ticker import MaxNLocator, StrMethodFormatter

from ..results.cell_types import counted
from ..results.write_files import write_atomically
from . import style

SIZE = (4.6, 3.0)  # inches
SUFFIXES = (".pdf", ".png", ".svg")


def draw_quality_histogram(histogram):
    """The figure of a QualityHistogram: cells by mean ratio, types of cells on top of each other, the most
    frequent at the bottom."""
    figure, axes = style.pyplot.subplots(figsize=SIZE, layout="constrained")
    shown, below = [], 0
    present = {name: counts for name, counts in histogram.counts.items() if counts.sum()}
    for name, counts in sorted(present.items(), key=lambda item: -item[1].sum()):
        shown.append(axes.bar(
            histogram.lower, counts, histogram.upper - histogram.lower, below, align="edge",
            color=style.ELEMENT_COLOURS[name], edgecolor="white", linewidth=0.3,
            label=counted(int(counts.sum()), name)))
        below = below + counts
    for value, symbol, dashes in ((histogram.q_min, r"q_{\min}", (1.5, 1.5)),
                                  (histogram.q_mean, r"q_{\mathrm{mean}}", (5, 2))):
        if value is not None:
            shown.append(axes.axvline(value, color=style.OUTLINE_COLOUR, linewidth=0.9, dashes=dashes,
                                      label=f"${symbol} = {value:.4f}$"))
    axes.set(xlim=(histogram.lower.min(), histogram.upper.max()), ylim=(0, 1.05 * below.max()),
             xlabel="mean ratio $q$", ylabel="number of cells")
    axes.yaxis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
    axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    axes.grid(axis="x", visible=False)
    # A file name is text, not mathematics.
    title = axes.set_title(histogram.title + (f" ({histogram.n_invalid:,} invalid)"
                                              if histogram.n_invalid else ""), parse_math=False)
    title.set_wrap(True)
    axes.legend(handles=shown, loc="best", fontsize=8, handlelength=1.8, frameon=True,
                facecolor="white", edgecolor="none", framealpha=0.9)
    return figure


def write_quality_histogram(histogram, path):
    """Draws it into a file that ends with one of SUFFIXES; returns the path."""
    style.apply_style()
    figure = draw_quality_histogram(histogram)
    suffix = Path(path).suffix[1:].lower()
    path = write_atomically(path, style.figure_bytes(figure, suffix, histogram.title))
    style.pyplot.close(figure)
    return path
