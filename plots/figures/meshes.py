# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 6.3 of the thesis: initial and smoothed meshes, elements coloured by their mean ratio."""

import math

import matplotlib.pyplot as pyplot
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PathCollection, PolyCollection
from matplotlib.colors import Normalize
from matplotlib.patches import PathPatch, Rectangle

from . import style
from .planar_geometry import bounding_box, cells_in, outline_path, paths_of, polygons_of, window_of

MOST_COLUMNS = 4
DETAIL_ASPECT = 1.3
# Centre and width of the detail, relative to the bounding box: a tooth and part of a hole of the gear.
DETAIL_CENTRE, DETAIL_WIDTH = (0.83, 0.62), 0.33
MOST_VECTORS = 5000  # cells of a full view; more of them as vectors would make huge files
QUALITY_RANGE = Normalize(0.0, 1.0)

# Heights in inches of everything except panels.
CAPTION, BLOCK_TITLE, FOOT = 0.21, 0.26, 0.62


def draw_meshes(blocks, detail=None):
    """A figure with a block of panels for each mesh.

    `blocks` is a list of (title, [(panel title, grid), ...]); `detail` is (centre, width), see
    window_of, or None for full views. A free panel in a block of details shows where they lie.
    """
    grids = [grid for _, panels in blocks for _, grid in panels]
    aspect = DETAIL_ASPECT if detail else min(max(box_aspect(grids[0]), 0.5), 3.0)
    windows = [window_of(panels[0][1], *detail, aspect) if detail else None for _, panels in blocks]

    def overview(axes, number):
        draw_overview(axes, blocks[number][1][0][1], windows[number])
        caption(axes, "Position of the detail")
    return draw_blocks(blocks, columns_of(blocks, MOST_COLUMNS, bool(detail)), aspect,
                       lambda axes, grid, number: draw_mesh(axes, grid, windows[number]),
                       overview if detail else None)


def columns_of(blocks, most, with_free=False):
    """The least number of columns that needs no more rows than `most` columns do, so that rows are
    about equally full; `with_free` if each block shall have a free panel. `most` at the usual width."""
    most = style.columns_that_fit(most)
    n_panels = max(len(panels) for _, panels in blocks) + with_free
    return math.ceil(n_panels / math.ceil(n_panels / most))


def draw_blocks(blocks, columns, aspect, draw_panel, draw_free=None, draw_foot=None):
    """A figure of blocks of panels below each other, in rows of `columns`, with a colour bar or what
    `draw_foot` draws into the figure of a height in inches.

    `blocks` is a list of (title, [(panel title, content), ...]), `aspect` width over height of a
    panel, or a list of one for each block. `draw_panel` gets axes, content and the number of the
    block, `draw_free` draws the first free panel of a block.
    """
    gap = 0.08
    width = (style.full_width() - (columns + 1) * gap) / columns
    heights = width / np.broadcast_to(aspect, len(blocks))
    rows = [rows_of_panels(panels, columns) for _, panels in blocks]
    total = np.dot(rows, heights + CAPTION) + len(blocks) * BLOCK_TITLE + FOOT
    figure = pyplot.figure(figsize=(style.full_width(), total))

    def add_axes(column, top, height):
        return figure.add_axes([(gap + column * (width + gap)) / style.full_width(),
                                (top - height) / total, width / style.full_width(), height / total])
    top = total
    for number, ((title, panels), n_rows, height) in enumerate(zip(blocks, rows, heights)):
        figure.text(0.5, (top - 0.7 * BLOCK_TITLE) / total, title, ha="center", fontsize=10)
        top -= BLOCK_TITLE
        for i in range(n_rows * columns):
            axes = add_axes(i % columns, top - i // columns * (height + CAPTION), height)
            if i < len(panels):
                draw_panel(axes, panels[i][1], number)
                caption(axes, panels[i][0])
            elif draw_free and i == len(panels):
                draw_free(axes, number)
            else:
                axes.axis("off")
        top -= n_rows * (height + CAPTION)
    (draw_foot or colour_bar)(figure, total)
    return figure


def rows_of_panels(panels, columns):
    """The number of rows that a block of panels takes."""
    return math.ceil(len(panels) / columns)


def box_aspect(grid):
    """Width over height of a grid's bounding box."""
    x_min, y_min, x_max, y_max = bounding_box(grid)
    return (x_max - x_min) / (y_max - y_min)


def caption(axes, text):
    """The caption below a panel; a long one is smaller, so that it does not touch the next one."""
    label = axes.text(0.5, -0.025, text, transform=axes.transAxes, ha="center", va="top")
    extent = label.get_window_extent(axes.figure.canvas.get_renderer())
    label.set_fontsize(label.get_fontsize() * min(1.0, axes.bbox.width / extent.width))


def draw_mesh(axes, grid, window):
    """The cells of a mesh coloured by the cell data `mean_ratio`, in a window or as a whole."""
    chosen = None if window is None else cells_in(grid, window)
    quality = grid.cell_data["mean_ratio"]
    # In a full view dark edges would hide the colours of the smallest elements.
    edges = {"edgecolors": "0.15", "linewidths": 0.25} if window is not None else {
        "edgecolors": "face", "linewidths": 0.1}
    kind, shapes = (PathCollection, paths_of) if grid.curved else (PolyCollection, polygons_of)
    cells = kind(shapes(grid, chosen), cmap=style.QUALITY_MAP, norm=QUALITY_RANGE, joinstyle="round", **edges)
    cells.set_array(quality if chosen is None else quality[chosen])
    cells.set_rasterized(window is None and len(quality) > MOST_VECTORS)
    axes.add_collection(cells)
    frame(axes, window if window is not None else bounding_box(grid), boxed=window is not None)


def draw_overview(axes, grid, window):
    """The outline of the domain with the window of the details."""
    axes.add_patch(PathPatch(outline_path(grid), facecolor=style.FILL_COLOUR, linewidth=0.5,
                             edgecolor=style.OUTLINE_COLOUR))
    axes.add_patch(Rectangle(window[:2], window[2] - window[0], window[3] - window[1],
                             facecolor="none", edgecolor="#D55E00", linewidth=1.2))
    frame(axes, bounding_box(grid), boxed=False)


def frame(axes, window, boxed):
    """Limits, equal scales and no ticks; a thin box around details only."""
    x_min, y_min, x_max, y_max = window
    margin = 0.0 if boxed else 0.02 * max(x_max - x_min, y_max - y_min)
    axes.set(xlim=(x_min - margin, x_max + margin), ylim=(y_min - margin, y_max + margin),
             xticks=(), yticks=(), aspect="equal")
    axes.grid(False)
    for spine in axes.spines.values():
        spine.set_visible(boxed)


def colour_bar(figure, total):
    """The one colour bar of all panels, at the foot of the figure."""
    axes = figure.add_axes([0.25, 0.36 / total, 0.5, 0.11 / total])
    bar = figure.colorbar(ScalarMappable(QUALITY_RANGE, style.QUALITY_MAP), cax=axes,
                          orientation="horizontal", ticks=(0, 0.2, 0.4, 0.6, 0.8, 1))
    bar.outline.set_linewidth(0.5)
    bar.ax.grid(False)
    bar.set_label("Mean ratio quality number $q$", labelpad=1)
