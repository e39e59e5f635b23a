# SPDX-License-Identifier: GPL-3.0-or-later
"""Defines the style of all figures: sizes, fonts, colours, and the colour, marker and dashes of each method.

Colours are those of M. Okabe and K. Ito, "Color Universal Design" (2008), without its yellow, which
is too light for thin lines, and more for methods of the user. Marker and dashes differ as well, so that print in grey stays
readable.
"""

import io
from dataclasses import dataclass, replace

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # noqa: E402  (the backend has to be chosen first)
import matplotlib.ticker  # noqa: E402,F401

from ..results.cell_types import ANY_CELL  # noqa: E402
from ..results.smoothing import INITIAL  # noqa: E402
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
INITIAL_COLOUR = "0.45"
FILL_COLOUR, OUTLINE_COLOUR = "#dbe7f0", "0.15"
# A type of elements has the same colour in every figure.
ELEMENT_COLOURS = {"triangle": "#0072B2", "quadrilateral": "#E69F00", "polygon": "#009E73",
                   "tetrahedron": "#0072B2", "hexahedron": "#E69F00", "prism": "#009E73",
                   "pyramid": "#CC79A7", ANY_CELL: "0.6"}


@dataclass(frozen=True)
class MethodStyle:
    """Colour, marker and dash pattern of a method's line."""

    colour: str
    marker: str
    dashes: tuple  # on, off, ... in line widths; empty: solid
    hollow: bool = False  # whether the marker is white inside

    @property
    def marker_fill(self):
        """The colour inside the marker."""
        return "white" if self.hollow else self.colour


KNOWN_METHODS = {
    "getme": MethodStyle("#D55E00", "o", ()),
    "global-optimization": MethodStyle("#009E73", "^", (5, 1.5)),
    "smart-laplace": MethodStyle("#E69F00", "s", (1.2, 1.2)),
    "weighted-laplace": MethodStyle("#0072B2", "D", (5, 1.5, 1.2, 1.5)),
    "laplace": MethodStyle("#56B4E9", "v", (3, 1.2)),
    "getme-simultaneous": MethodStyle("#CC79A7", "P", (8, 1.5)),
    "getme-sequential": MethodStyle("#000000", "X", (2.5, 2.5)),
    "getme-adaptive": MethodStyle("#8B4513", "<", (8, 1.5, 2, 1.5)),
    "getme-qgamma": MethodStyle("#7A3E9D", ">", (3, 1.2, 1.2, 1.2)),
}

# Of all other methods. No known method has these colours. They are far from those and from each other, as seen with normal
# sight, without red cones and without green cones (LEAST_DISTANCE in plots/tests/test_figures.py); the most different ones first.
OWN_COLOURS = ("#0000FF", "#663355", "#99BB66", "#FF8899", "#448844", "#664433", "#6666FF", "#4411AA")
OWN_MARKERS = ("*", "p", "d", "h", "P", "<", "X", ">", "D", "8")
OWN_DASHES = ((6, 1, 1, 1, 1, 1), (2, 1), (10, 2), (1, 2), (4, 1, 2, 1), (7, 1, 1, 1), (2, 2, 6, 2), (12, 1.5, 2, 1.5))


def own_style(number):
    """The style of the method of this number, from 0, of those without a style of their own. After all colours, they
    come again with other markers and dashes."""
    turn = number // len(OWN_COLOURS)
    return MethodStyle(OWN_COLOURS[number % len(OWN_COLOURS)], OWN_MARKERS[(number + turn) % len(OWN_MARKERS)],
                       OWN_DASHES[(number + 3 * turn) % len(OWN_DASHES)])


# How the name of a method ends that is the one of the same name on several threads.
PARALLEL_SUFFIX = "-parallel"
PARALLEL_DASHES = (6, 1.5, 1, 1.5, 1, 1.5)


def sequential_name(method):
    """The name of the method on one thread."""
    return method.removesuffix(PARALLEL_SUFFIX)


def method_styles(methods):
    """A style for each method of a study. The known ones always have the same; the others take theirs in the order of the
    study, so that a method that is added at the end changes no other. A parallel method
    looks like its sequential one with a hollow marker and other dashes."""
    sequential = dict.fromkeys(map(sequential_name, methods))
    others = [name for name in sequential if name not in KNOWN_METHODS]
    found = {**KNOWN_METHODS, **{name: own_style(number) for number, name in enumerate(others)}}
    styles = {name: found[sequential_name(name)] for name in methods}
    styles.update((name, replace(look, dashes=PARALLEL_DASHES, hollow=True))
                  for name, look in styles.items() if name != sequential_name(name))
    styles[INITIAL] = MethodStyle(INITIAL_COLOUR, "", ())
    return styles


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
    figure.savefig(stream, format=suffix.lower(), dpi=DPI, metadata=metadata)
    return stream.getvalue()


def save_figure(figure, folder, name, title, formats):
    """Writes `name`.pdf and so on, closes the figure and returns the paths."""
    paths = [write_atomically(folder / f"{name}.{suffix}", figure_bytes(figure, suffix, title))
             for suffix in formats]
    pyplot.close(figure)
    return paths
