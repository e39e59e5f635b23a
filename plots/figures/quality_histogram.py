# SPDX-License-Identifier: GPL-3.0-or-later
"""python3 -m plots.quality_histogram <file>: the histogram that `smoothfem quality` writes.

Reads JSON from the standard input: `title`, `n_invalid`, `q_min`, `q_mean`, and
`histogram`, for each element type the numbers of cells in equal parts of [0, 1].
"""

import json
import sys
from pathlib import Path

from ..results.cell_types import counted
from ..results.write_files import write_atomically
from . import style

SIZE = (4.6, 3.0)  # inches
SUFFIXES = ("pdf", "png", "svg")


def draw_quality_histogram(numbers):
    """The figure: cells by mean ratio, element types on top of each other."""
    figure, axes = style.pyplot.subplots(figsize=SIZE, layout="constrained")
    histogram = {name: counts for name, counts in numbers["histogram"].items() if sum(counts)}
    n_bins = len(next(iter(histogram.values())))
    lefts = [b / n_bins for b in range(n_bins)]
    below = [0] * n_bins
    shown = []
    for name, counts in sorted(histogram.items(), key=lambda item: -sum(item[1])):
        bars = axes.bar(lefts, counts, 1 / n_bins, below, align="edge", color=style.ELEMENT_COLOURS[name],
                        edgecolor="white", linewidth=0.3, label=counted(sum(counts), name))
        shown.append(bars)
        below = [low + count for low, count in zip(below, counts)]
    for value, name, dashes in ((numbers["q_min"], r"q_{\min}", (1.5, 1.5)),
                                (numbers["q_mean"], r"q_{\mathrm{mean}}", (5, 2))):
        shown.append(axes.axvline(value, color=style.OUTLINE_COLOUR, linewidth=0.9, dashes=dashes,
                                  label=f"${name} = {value:.4f}$"))
    axes.set_xlim(0, 1)
    axes.set_ylim(0, 1.05 * max(below))
    axes.set_xlabel("mean ratio $q$")
    axes.set_ylabel("number of cells")
    axes.yaxis.set_major_formatter(style.matplotlib.ticker.StrMethodFormatter("{x:,.0f}"))
    axes.yaxis.set_major_locator(style.matplotlib.ticker.MaxNLocator(integer=True))
    axes.grid(axis="x", visible=False)
    # A file name is text, not mathematics.
    title = axes.set_title(numbers["title"] + (f" ({numbers['n_invalid']:,} invalid)"
                                               if numbers["n_invalid"] else ""), parse_math=False)
    title.set_wrap(True)
    axes.legend(handles=shown, loc="best", fontsize=8, handlelength=1.8, frameon=True,
                facecolor="white", edgecolor="none", framealpha=0.9)
    return figure


def main(arguments=None, stream=None):
    """Runs the command line; returns the exit code: 0, or 2 if the file cannot be written."""
    arguments = sys.argv[1:] if arguments is None else arguments
    if len(arguments) != 1 or Path(arguments[0]).suffix[1:].lower() not in SUFFIXES:
        print("Give one file that ends with .pdf, .png or .svg.", file=sys.stderr)
        return 2
    numbers = json.load(stream or sys.stdin)
    style.apply_style()
    figure = draw_quality_histogram(numbers)
    try:
        write_atomically(arguments[0], style.figure_bytes(figure, Path(arguments[0]).suffix[1:].lower(),
                                                          numbers["title"]))
    except OSError as error:
        print(f"The figure cannot be written: {error}.", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
