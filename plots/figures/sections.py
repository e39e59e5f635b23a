# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 6.6 of the thesis: initial and smoothed volume meshes, cut open, cells coloured by their
mean ratio."""

from dataclasses import replace

import numpy as np
from matplotlib import colormaps

from ..results.method_styles import INITIAL_COLOUR
from . import style
from .meshes import QUALITY_RANGE, columns_of, draw_blocks
from .planar_geometry import LEAST_FILLED
from .render import Scene, render
from .section_geometry import area_of, in_plane, section
from .volume_geometry import Cut, cell_centres, same_box, widest_cut

MOST_COLUMNS = 5
DETAIL_ASPECT = 1.0
# Along the width of a detail: enough cells to see a pattern, few enough to see each; less where the cut
# is narrow.
DETAIL_CELLS = (16, 12, 9, 6)
IMAGE_DPI = 600  # of the printed panel
# Where most cells are smaller than so many pixels, edges would hide the colours between them.
PIXELS_FOR_EDGES = 14.0
AMBIENT = 0.78  # bright enough to find the colours in the colour bar, shaded enough to see the faces


def draw_sections(blocks, detail=False, normal=None):
    """A figure with a block of panels for each mesh; raises NoDisplay if nothing can be rendered.

    `blocks` is a list of (title, [(panel title, grid or None), ...]), None for a mesh that is
    missing. `normal` of the cut, or None for the cut that crosses most cells.
    """
    columns = columns_of(blocks, MOST_COLUMNS)
    cuts = cuts_of(blocks, normal)
    views = views_of(blocks, cuts, detail)
    aspect = DETAIL_ASPECT if detail else min(max(views[0].width / views[0].height, 0.5), 3.0)
    pixels = pixels_of(columns, aspect)
    scenes = []
    for (_, panels), cut, view in zip(blocks, cuts, views):
        view = view.fitted(aspect)
        edges = shows_edges(first_grid(panels), cut, view, pixels)
        scenes += [section_scene(grid, cut, view, pixels, edges, quality_colours(grid))
                   for _, grid in panels if grid is not None]
    pictures = iter(render(scenes))
    shown = [(title, [(name, None if grid is None else next(pictures)) for name, grid in panels])
             for title, panels in blocks]
    return draw_blocks(shown, columns, aspect, lambda axes, picture, _: show(axes, picture, detail))


def first_grid(panels):
    """The first mesh of a block that is there."""
    return next(grid for _, grid in panels if grid is not None)


def cuts_of(blocks, normal):
    """A cut for each block. All have the normal of the first, so that meshes of one solid are cut
    alike, and go through the middle of their own bounding boxes."""
    found = []
    for _, panels in blocks:
        grid = first_grid(panels)
        if normal is None:
            normal = widest_cut(grid).normal
        middle = 0.5 * (grid.points.min(axis=0) + grid.points.max(axis=0))
        found.append(Cut(tuple(middle), tuple(normal)))
    return found


def views_of(blocks, cuts, detail):
    """A view for each block; blocks of the same solid have the same."""
    found, grids = [], [first_grid(panels) for _, panels in blocks]
    for number, (grid, cut) in enumerate(zip(grids, cuts)):
        twin = next((i for i in range(number) if same_box(grids[i], grid)), None)
        if twin is not None:
            found.append(found[twin])
            continue
        view = cut.view(grid)
        found.append(view.zoomed(*detail_of(grid, cut, view), DETAIL_ASPECT) if detail else view)
    return found


def detail_of(grid, cut, view):
    """(centre, width) of a window on the cut, so small that cells fill half of it."""
    polygons, cells = section(replace(grid, curved=None), cut)  # straight edges are exact enough to place a window
    sizes = np.array([area_of(polygon) for polygon in polygons])
    middles = in_plane(cell_centres(grid)[cells], cut)
    for cells_across in DETAIL_CELLS:
        centre, width = cut.densest_window(grid, view, cells_across)
        inside = np.all(np.abs(middles - in_plane(np.atleast_2d(centre), cut)) < 0.5 * width, axis=1)
        if sizes[inside].sum() >= LEAST_FILLED * width**2 / DETAIL_ASPECT:
            break
    return centre, width


def pixels_of(columns, aspect):
    """Width and height of the picture of a panel."""
    width = round(IMAGE_DPI * style.full_width() / columns)
    return width, round(width / aspect)


def shows_edges(grid, cut, view, pixels):
    """True if cells are large enough in the picture to show edges; decided once for all panels of a block, so that they
    can be compared."""
    return bool(cut.seen_spacing(grid) * pixels[0] / view.width >= PIXELS_FOR_EDGES)


def quality_colours(grid):
    """The colours of the cells' mean ratios, shape (n_cells, 3), uint8."""
    return colormaps[style.QUALITY_MAP](QUALITY_RANGE(grid.cell_data["mean_ratio"]),
                                        bytes=True)[:, :3]


def section_scene(grid, cut, view, pixels, edges, colours):
    """The cells on the far side of the cut in these colours, shape (n_cells, 3)."""
    return Scene(grid, view, pixels, cells=cut.kept(grid), cell_colours=colours, ambient=AMBIENT,
                 cell_edges=edges)


def show(axes, picture, boxed):
    """Shows a rendered picture, or a word if it is missing."""
    axes.set(xticks=(), yticks=())
    axes.grid(False)
    for spine in axes.spines.values():
        spine.set_visible(boxed)
    if picture is None:
        axes.text(0.5, 0.5, "no mesh", transform=axes.transAxes, ha="center", va="center",
                  color=INITIAL_COLOUR)
    else:
        axes.imshow(np.asarray(picture), aspect="auto")
