# SPDX-License-Identifier: GPL-3.0-or-later
"""Defines the style of all figures: sizes, fonts, colours."""

import io

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # noqa: E402  (the backend has to be chosen first)
import matplotlib.ticker  # noqa: E402,F401

from ..results.cell_types import ANY_CELL  # noqa: E402
from ..results.write_files import write_atomically  # noqa: E402

SINGLE_WIDTH, FULL_WIDTH = 3.4, 7.0  # inches: one and two columns of a journal page
DPI = 300

SETTINGS = {
    "font.family": "serif", "font.serif": ["STIXGeneral"], "mathtext.fontset": "stix",
    "font.size": 9, "axes.labelsize": 9, "axes.titlesize": 9, "xtick.labelsize": 8,
    "ytick.labelsize": 8, "legend.fontsize": 9, "axes.linewidth": 0.6, "xtick.major.width": 0.6,
    "ytick.major.width": 0.6, "xtick.minor.width": 0.4, "ytick.minor.width": 0.4,
    "xtick.direction": "in", "ytick.direction": "in", "lines.linewidth": 1.0,
    "grid.linewidth": 0.4, "grid.color": "0.88", "axes.grid": True, "axes.axisbelow": True,
    "legend.frameon": False, "savefig.dpi": DPI,
    # Type 42: text in the PDF stays text and needs no Type 3 fonts, which some journals refuse.
    "pdf.fonttype": 42,
    # Names inside a svg file are made from this instead of random numbers.
    "svg.hashsalt": "smoothfem", "svg.fonttype": "none",
}

QUALITY_MAP = "RdYlBu"  # low quality red, high quality blue; safe for the colour-blind
SOLUTION_MAP = "viridis"
FILL_COLOUR, OUTLINE_COLOUR = "#dbe7f0", "0.15"
# A type of elements has the same colour in every figure.
ELEMENT_COLOURS = {"triangle": "#0072B2", "quadrilateral": "#E69F00", "polygon": "#009E73",
                   "tetrahedron": "#0072B2", "hexahedron": "#E69F00", "prism": "#009E73",
                   "pyramid": "#CC79A7", ANY_CELL: "0.6"}


def apply_style(width=FULL_WIDTH):
    """Makes the settings those of all figures drawn from now on; they are so many inches wide, at the
    usual width less where they have little to show."""
    matplotlib.rcdefaults()
    matplotlib.rcParams.update(SETTINGS)
    matplotlib.rcParams["figure.figsize"] = (width, 0.7 * width)


def full_width():
    """The width in inches of a figure that has much to show."""
    return matplotlib.rcParams["figure.figsize"][0]


def width_of(narrower):
    """The width of a figure to which less than the usual width would do: that, unless another width is
    asked for."""
    return narrower if full_width() == FULL_WIDTH else full_width()


def columns_that_fit(usual):
    """The number of columns of panels that fit, if `usual` columns fit at the usual width."""
    return max(1, int(usual * full_width() / FULL_WIDTH + 0.5))


def figure_bytes(figure, suffix, title):
    """The figure as the content of a pdf, png or svg file, without a date: the same figure gives the
    same bytes."""
    metadata = {"pdf": {"Title": title, "Creator": "smoothfem", "CreationDate": None},
                "png": {"Title": title, "Software": "smoothfem"},
                "svg": {"Title": title, "Creator": "smoothfem", "Date": None}}[suffix.lower()]
    stream = io.BytesIO()
    # Of PNG files, a higher level takes three times as long for files that are 10 % smaller.
    fast = {"pil_kwargs": {"compress_level": 2}} if suffix.lower() == "png" else {}
    figure.savefig(stream, format=suffix.lower(), dpi=DPI, metadata=metadata, **fast)
    return stream.getvalue()


def save_figure(figure, folder, name, title, formats):
    """Writes `name`.pdf and so on, closes the figure and returns the paths."""
    paths = [write_atomically(folder / f"{name}.{suffix}", figure_bytes(figure, suffix, title))
             for suffix in formats]
    pyplot.close(figure)
    return paths
