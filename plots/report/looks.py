# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours, marks and dashes of the figures, as Plotly's scripts call them."""

from ..results.method_styles import method_styles

SYMBOLS = {"": "circle", "o": "circle", "^": "triangle-up", "s": "square", "D": "diamond", "v": "triangle-down", "P": "cross",
           "X": "x", "<": "triangle-left", ">": "triangle-right", "*": "star", "p": "pentagon", "d": "diamond-tall",
           "h": "hexagon", "8": "octagon"}
PIXELS = 2  # of a line's width


def looks_of(methods):
    """Method -> colour, symbol and dash, for JSON; methods: all of the study."""
    return {name: {"colour": style.colour, "symbol": SYMBOLS[style.marker] + ("-open" if style.hollow else ""),
                   "dash": ",".join(f"{PIXELS * length:g}px" for length in style.dashes) or "solid"}
            for name, style in method_styles(methods).items()}
