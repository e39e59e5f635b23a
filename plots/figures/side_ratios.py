# SPDX-License-Identifier: GPL-3.0-or-later
"""Convergence of the ratio of two sides of a triangle to one (thesis, Propositions 2.1 and 2.3)."""

import math

import matplotlib.pyplot as pyplot
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter

from ..results.method_styles import KNOWN_METHODS
from ..results.rows import groups_of
from . import style

TITLES = {"equilateral": "Equilateral case: $1-y/x$", "right-isosceles": "Right isosceles case: $1-z/y$"}
LEAST, BELOW = 1e-13, 1e-14  # below the first is rounding; the second is outside of the panel
MARKED_EVERY = 3


def draw_side_ratios(results):
    """A panel for each transformation, a line for each angle; dotted: the bound of every second step."""
    parts = groups_of(results.side_ratios, "transformation")
    looks = list(KNOWN_METHODS.values())
    figure, axes = pyplot.subplots(1, len(parts), squeeze=False, sharey=True,
                                   figsize=(style.full_width(), 2.9))
    figure.subplots_adjust(left=0.09, right=0.99, bottom=0.14, top=0.84, wspace=0.06)
    handles = {}
    for ax, ((transformation,), part) in zip(axes[0], parts):
        for number, (look, ((theta,), line)) in enumerate(zip(looks, groups_of(part, "theta"))):
            step, defect, bound = (line.number(name) for name in ("step", "defect", "bound"))
            # Down to the first step that is exact up to rounding, where the line leaves the panel.
            n_shown = np.count_nonzero(np.minimum.accumulate(defect) > LEAST) + 1
            handles[rf"$\theta={math.degrees(float(theta)):.0f}^\circ$"] = ax.plot(
                step[:n_shown], np.maximum(defect[:n_shown], BELOW), color=look.colour, marker=look.marker,
                # Lines that coincide have their markers side by side.
                markersize=3.5, markevery=(number % MARKED_EVERY, MARKED_EVERY))[0]
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
