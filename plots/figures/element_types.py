# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 5.35, 5.39 and 5.43 of the thesis: mixed volume meshes, cut open, cells coloured by their
type."""

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.patches import Patch

from ..results.cell_types import VOLUME_CELL_TYPES, counted
from . import style
from .meshes import draw_blocks
from .render import render
from .sections import DETAIL_ASPECT, cuts_of, pixels_of, section_scene, show, shows_edges, views_of

WHITE_FRACTION = 0.35  # of the colours: lighter ones let edges be seen


def is_mixed(grid):
    """True if a mesh has cells of more than one type."""
    return len(np.unique(grid.types)) > 1


def draw_element_types(blocks, normal=None):
    """A figure with a row for each mesh; raises NoDisplay if nothing can be rendered.

    `blocks` is a list of (title, [(panel title, grid), ...]); each grid is shown as a whole and in
    detail. `normal` of the cut as in draw_sections.
    """
    cuts = cuts_of(blocks, normal)
    columns = style.columns_that_fit(2 * max(len(panels) for _, panels in blocks))
    pixels = pixels_of(columns, DETAIL_ASPECT)
    shown, scenes = [], []
    for number, (title, panels) in enumerate(blocks):
        contents = []
        for detail in (False, True):
            view = views_of(blocks, cuts, detail)[number].fitted(DETAIL_ASPECT)
            edges = shows_edges(panels[0][1], cuts[number], view, pixels)
            for name, grid in panels:
                contents.append((f"{name}, detail" if detail else name, (len(scenes), detail)))
                scenes.append(section_scene(grid, cuts[number], view, pixels, edges,
                                            type_colours(grid)))
        shown.append((f"{title}: {counts_of_types(panels[0][1])}", contents))
    pictures = render(scenes)
    types = sorted({int(t) for _, panels in blocks for t in np.unique(panels[0][1].types)})
    return draw_blocks(shown, columns, DETAIL_ASPECT,
                       lambda axes, content, _: show(axes, pictures[content[0]], content[1]),
                       draw_foot=lambda figure, total: legend_of_types(figure, types, total))


def light_colour(cell_type):
    """The colour of a type, mixed with white; red, green and blue from 0 to 1."""
    colour = np.array(to_rgb(style.ELEMENT_COLOURS[VOLUME_CELL_TYPES[cell_type]]))
    return (1 - WHITE_FRACTION) * colour + WHITE_FRACTION


def type_colours(grid):
    """The colours of the cells' types, shape (n_cells, 3), uint8."""
    colours = np.zeros((len(grid.types), 3), dtype=np.uint8)
    for cell_type in np.unique(grid.types):
        colours[grid.types == cell_type] = np.round(255 * light_colour(int(cell_type)))
    return colours


def counts_of_types(grid):
    """'24 tetrahedra, 3 prisms'."""
    types, counts = np.unique(grid.types, return_counts=True)
    return ", ".join(counted(int(n), VOLUME_CELL_TYPES[int(t)]) for t, n in zip(types, counts))


def legend_of_types(figure, types, total):
    """The legend at the foot of the figure of a height in inches."""
    handles = [Patch(facecolor=light_colour(t), edgecolor=style.OUTLINE_COLOUR, linewidth=0.4,
                     label=VOLUME_CELL_TYPES[t].capitalize()) for t in types]
    figure.legend(handles=handles, loc="lower center", ncol=len(handles), handlelength=1.4,
                  bbox_to_anchor=(0.5, 0.2 / total))
