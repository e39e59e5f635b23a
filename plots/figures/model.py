# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 6.2 of the thesis: the model, and the model coloured by the exact solution."""

import matplotlib.pyplot as pyplot
from matplotlib.patches import PathPatch

from . import style
from .planar_geometry import bounding_box, outline_path
from .resample import resampled

IMAGE_DPI = 300


def draw_model(grid):
    """A figure of the domain's outline (a) and of the point data `exact_solution` (b)."""
    x_min, y_min, x_max, y_max = bounding_box(grid)
    ratio = min(max((y_max - y_min) / (x_max - x_min), 0.3), 1.6)
    figure, axes = pyplot.subplots(1, 2, figsize=(style.full_width(), 0.45 * style.full_width() * ratio + 0.35))
    figure.subplots_adjust(left=0.01, right=0.905, bottom=0.09, top=0.985, wspace=0.02)
    for ax, letter, text in zip(axes, "ab", ("Model", "Exact solution $u$")):
        margin = 0.02 * (x_max - x_min)
        ax.set(xlim=(x_min - margin, x_max + margin), ylim=(y_min - margin, y_max + margin),
               aspect="equal")
        ax.axis("off")
        ax.text(0.5, -0.015, f"({letter}) {text}", transform=ax.transAxes, ha="center", va="top")
    path = outline_path(grid)
    axes[0].add_patch(PathPatch(path, facecolor=style.FILL_COLOUR, edgecolor=style.OUTLINE_COLOUR,
                                linewidth=0.8, joinstyle="round"))
    values = grid.point_data["exact_solution"]
    width = axes[1].get_position().width * figure.get_figwidth()
    # Values between the nodes, each in its own colour: mixed colours of nodes would be in no colour map.
    colours = axes[1].imshow(
        resampled(grid, values, round(IMAGE_DPI * width)), cmap=style.SOLUTION_MAP, vmin=values.min(),
        vmax=values.max(), extent=(x_min, x_max, y_min, y_max), origin="lower", interpolation="nearest")
    outline = PathPatch(path, facecolor="none", edgecolor=style.OUTLINE_COLOUR, linewidth=0.5,
                        joinstyle="round")
    axes[1].add_patch(outline)
    colours.set_clip_path(outline)
    box = axes[1].get_position()
    bar = figure.colorbar(colours, cax=figure.add_axes(
        [0.925, box.y0 + 0.08 * box.height, 0.018, 0.84 * box.height]))
    bar.outline.set_linewidth(0.5)
    bar.ax.set_title("$u$", pad=5)
    bar.ax.grid(False)
    return figure
