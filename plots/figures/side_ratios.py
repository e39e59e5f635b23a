# SPDX-License-Identifier: GPL-3.0-or-later
"""How fast the ratio of two sides of a triangle tends to one (thesis, Propositions 2.1 and 2.3)."""

import math

import matplotlib.pyplot as pyplot
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter

from ..results.rows import groups_of
from . import style

TITLES = {"equilateral": "Equilateral case: $1-y/x$", "right-isosceles": "Right isosceles case: $1-z/y$"}
LEAST = 1e-13  # below is rounding


def draw_side_ratios(results):
    """A panel for each transformation, a line for each angle; dotted: the bound of every second step."""
    parts = groups_of(results.side_ratios, "transformation")
    looks = list(style.KNOWN_METHODS.values())
    figure, axes = pyplot.subplots(1, len(parts), squeeze=False, sharey=True,
                                   figsize=(style.FULL_WIDTH, 2.9))
    figure.subplots_adjust(left=0.09, right=0.99, bottom=0.14, top=0.84, wspace=0.06)
    handles = {}
    for ax, ((transformation,), part) in zip(axes[0], parts):
        for look, ((theta,), line) in zip(looks, groups_of(part, "theta")):
            step, defect, bound = (line.number(name) for name in ("step", "defect", "bound"))
            shown = defect > LEAST
            handles[rf"$\theta={math.degrees(float(theta)):.0f}^\circ$"] = ax.plot(
                step[shown], defect[shown], color=look.colour, marker=look.marker, markersize=3)[0]
            even = (step % 2 == 0) & (bound > LEAST)
            ax.plot(step[even], bound[even], color=look.colour, linestyle=(0, (1, 1.5)), linewidth=0.8)
        ax.set(yscale="log", ylim=(LEAST, 2), xlim=(0, 30), xlabel="Step",
               title=TITLES.get(transformation, transformation))
        ax.yaxis.set_major_locator(LogLocator(100.0, numticks=20))
        ax.yaxis.set_minor_formatter(NullFormatter())
    axes[0][0].set_ylabel("1 - shorter side / longer side")
    handles["bound"] = Line2D([], [], color="0.3", linestyle=(0, (1, 1.5)), linewidth=0.8)
    figure.legend(handles.values(), handles.keys(), loc="upper center", ncol=len(handles),
                  columnspacing=1.2, handlelength=1.8)
    return figure
