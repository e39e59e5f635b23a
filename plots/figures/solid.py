# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 6.5 of the thesis: the solid, and the solid coloured by the exact solution."""

import matplotlib.pyplot as pyplot
import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from . import style
from .render import Scene, render
from .volume_geometry import MODEL_DIRECTION, view_of

IMAGE_DPI = 600
# Inches: margins, the width of the colour bar with its labels, the captions.
MARGIN, BAR, CAPTION = 0.08, 0.62, 0.24


def draw_solid(grid):
    """A figure of the solid (a) and of the point data `exact_solution` on it (b); raises NoDisplay
    if nothing can be rendered."""
    width = 0.5 * (style.full_width() - 3 * MARGIN - BAR)
    view = view_of(grid.points, MODEL_DIRECTION)
    height = min(width * view.height / view.width, 1.6 * width)
    view = view.fitted(width / height)
    total = height + MARGIN + CAPTION
    values = grid.point_data["exact_solution"]
    scale = Normalize(values.min(), values.max())
    colours = colormaps[style.SOLUTION_MAP](np.arange(256), bytes=True)[:, :3]
    pixels = (round(IMAGE_DPI * width), round(IMAGE_DPI * height))
    plain = Scene(grid, view, pixels, feature_edges=True)
    pictures = render([plain, Scene(grid, view, pixels, point_values=np.asarray(scale(values)),
                                    value_colours=colours, feature_edges=True, ambient=0.7)])
    figure = pyplot.figure(figsize=(style.full_width(), total))

    def add_axes(left, bottom, breadth, tall):
        return figure.add_axes([left / style.full_width(), bottom / total, breadth / style.full_width(),
                                tall / total])
    for i, (picture, text) in enumerate(zip(pictures, ("(a) Model", "(b) Exact solution $u$"))):
        axes = add_axes(MARGIN + i * (width + MARGIN), CAPTION, width, height)
        axes.imshow(picture, aspect="auto")
        axes.axis("off")
        axes.annotate(text, (0.5, 0), (0, -10), "axes fraction", "offset points", ha="center")
    bar = figure.colorbar(ScalarMappable(scale, style.SOLUTION_MAP), cax=add_axes(
        3 * MARGIN + 2 * width, CAPTION + 0.1 * height, 0.13, 0.76 * height))
    bar.outline.set_linewidth(0.5)
    bar.ax.set_title("$u$", pad=5)
    bar.ax.grid(False)
    return figure
