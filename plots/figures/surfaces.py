# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 5.4 of the thesis: initial and smoothed surface meshes, cells coloured by their mean ratio."""

from .meshes import columns_of, draw_blocks
from .render import Scene, render
from .sections import AMBIENT, pixels_of, quality_colours, show
from .volume_geometry import view_of

MOST_COLUMNS = 3
# From the viewer's front and from above: a roof shows most of itself.
DIRECTION = (-0.35, -1.0, 1.1)


def draw_surfaces(blocks):
    """A figure with a block of panels for each mesh; raises NoDisplay if nothing can be rendered.

    `blocks` is a list of (title, [(panel title, grid), ...]).
    """
    columns = columns_of(blocks, MOST_COLUMNS)
    views = [view_of(panels[0][1].points, DIRECTION) for _, panels in blocks]
    aspect = min(max(views[0].width / views[0].height, 0.5), 3.0)
    pictures = iter(render([surface_scene(grid, view.fitted(aspect), pixels_of(columns, aspect))
                            for (_, panels), view in zip(blocks, views) for _, grid in panels]))
    shown = [(title, [(name, next(pictures)) for name, _ in panels]) for title, panels in blocks]
    return draw_blocks(shown, columns, aspect, lambda axes, picture, _: show(axes, picture, False))


def surface_scene(grid, view, pixels):
    """All cells in the colours of their mean ratios."""
    return Scene(grid, view, pixels, cell_colours=quality_colours(grid), outside_coloured=True,
                 ambient=AMBIENT)
