# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of a regularization study: Figures 3.4 and 3.8 of the thesis."""

import matplotlib.pyplot as pyplot

from ..results.regularization import whole
from . import style
from .planned import plan_numbered

# Markers and dash patterns; the colours are those of all figures.
ELEMENTS = {"tetrahedron": ("o", ()), "hexahedron": ("s", (5, 1.5)), "pyramid": ("^", (1.2, 1.2)),
            "prism": ("D", (5, 1.5, 1.2, 1.5))}
STARTS = {"arbitrary": "Arbitrary initial elements", "valid": "Valid initial elements"}
MOST_SHOWN = 50  # transformations; for small sigma their number has no bound
MARKED_EVERY = 10  # sigmas between the marks of the standard deviation


def draw_corridor(results):
    """Figure 3.4: least, mean and most transformations of tetrahedra by opposite face normals."""
    rows = whole(results.counts.select(element="tetrahedron", transformation="opposite-face-normals",
                                       start="valid"))
    figure, ax = pyplot.subplots(figsize=(style.width_of(1.3 * style.SINGLE_WIDTH), 2.6), constrained_layout=True)
    sigma = rows.number("sigma")
    ax.fill_between(sigma, rows.number("least"), rows.number("most"), color="0.85", linewidth=0,
                    label="least to most")
    ax.plot(sigma, rows.number("mean"), color=style.ELEMENT_COLOURS["tetrahedron"], label="mean")
    set_axes(ax)
    ax.legend(loc="upper right")
    return figure


def draw_speeds(results):
    """Figure 3.8: mean transformations of each element type, with standard deviations."""
    figure, axes = pyplot.subplots(1, len(STARTS), figsize=(style.full_width(), 2.8), sharey=True,
                                   constrained_layout=True)
    for ax, (start, title) in zip(axes, STARTS.items()):
        for element, (marker, dashes) in ELEMENTS.items():
            colour = style.ELEMENT_COLOURS[element]
            rows = whole(results.counts.select(element=element, transformation="dual-element", start=start))
            sigma, mean = rows.number("sigma"), rows.number("mean")
            line, = ax.plot(sigma, mean, color=colour, label=element.capitalize())
            if dashes:
                line.set_dashes(dashes)
            ax.errorbar(sigma[::MARKED_EVERY], mean[::MARKED_EVERY],
                        rows.number("deviation")[::MARKED_EVERY], fmt=marker, color=colour,
                        markersize=2.8, elinewidth=0.7, capsize=1.6, capthick=0.7)
        set_axes(ax)
        ax.set_title(title)
    axes[0].legend(loc="upper right")
    axes[1].set_ylabel("")
    return figure


def set_axes(ax):
    """Labels and limits."""
    ax.set(xlabel=r"Scaling factor $\sigma$", ylabel="Transformations", ylim=(0, MOST_SHOWN))
    ax.margins(x=0.02)


FIGURES = {"corridor": ("3_4", "opposite face normals", draw_corridor),
           "speeds": ("3_8", "dual element transformation", draw_speeds)}


def plan_regularization_figures(results):
    """All figures."""
    return plan_numbered(results, FIGURES)
