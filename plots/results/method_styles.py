# SPDX-License-Identifier: GPL-3.0-or-later
"""Defines the colour, marker and dashes of each method.

Colours are those of M. Okabe and K. Ito, "Color Universal Design" (2008), without its yellow, which
is too light for thin lines, and more for methods of the user. Marker and dashes differ as well, so that print in grey stays
readable.
"""

from dataclasses import dataclass, replace

from .smoothing import INITIAL

INITIAL_COLOUR = "0.45"


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
    "curved-optimization": MethodStyle("#000055", "h", (10, 1.5, 3, 1.5)),
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
