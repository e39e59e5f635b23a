# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 5.18 of the thesis: a coarse volume mesh as a whole, and sections of the initial and the
smoothed meshes by planes. Where cells are large, a cut along whole cells shows another layer of them
in each mesh."""

from matplotlib.collections import LineCollection, PolyCollection

from . import style
from .meshes import QUALITY_RANGE, columns_of, draw_blocks, frame
from .render import Scene, render
from .section_geometry import in_plane, section, section_lines
from .sections import AMBIENT, MOST_COLUMNS, first_grid, pixels_of, quality_colours, show
from .volume_geometry import MODEL_DIRECTION, Cut, view_of

MOST_CELLS = 1000  # of a coarse mesh
NORMALS = {"x": (1, 0, 0), "y": (0, -1, 0), "z": (0, 0, 1)}


def is_coarse(grid):
    """True if a mesh has so few cells that a cut along them is far from a plane."""
    return len(grid.types) <= MOST_CELLS


def draw_plane_sections(title, panels):
    """A figure of one mesh: a row of whole meshes from outside, and one for each of the planes through
    the middle across x, y and z. Raises NoDisplay if nothing can be rendered.

    `panels` is a list of (panel title, grid or None), None for a mesh that is missing.
    """
    first = first_grid(panels)
    columns = columns_of([(title, panels)], MOST_COLUMNS)
    view = view_of(first.points, MODEL_DIRECTION)
    aspect = in_range(view.width / view.height)
    pictures = iter(render([Scene(grid, view.fitted(aspect), pixels_of(columns, aspect),
                                  cell_colours=quality_colours(grid), outside_coloured=True,
                                  cell_edges=True, ambient=AMBIENT)
                            for _, grid in panels if grid is not None]))
    blocks = [(f"{title}, from outside",
               [(name, grid if grid is None else next(pictures)) for name, grid in panels])]
    middle = 0.5 * (first.points.min(axis=0) + first.points.max(axis=0))
    cuts = [Cut(tuple(middle), normal) for normal in NORMALS.values()]
    blocks += [(f"Section at ${axis}={value:.3g}$", panels) for axis, value in zip(NORMALS, middle)]
    windows = [window(first, cut) for cut in cuts]
    aspects = [aspect] + [in_range((x_max - x_min) / (y_max - y_min))
                          for x_min, y_min, x_max, y_max in windows]

    def draw_panel(axes, content, number):
        if number == 0 or content is None:
            show(axes, content, False)
        else:
            draw_section(axes, content, cuts[number - 1])
    return draw_blocks(blocks, columns, aspects, draw_panel)


def in_range(aspect):
    """Width over height of a panel that is neither a line nor a column."""
    return min(max(aspect, 0.8), 3.0)


def window(grid, cut):
    """(x_min, y_min, x_max, y_max) of a mesh in the plane of a cut."""
    flat = in_plane(grid.points, cut)
    return (*flat.min(axis=0), *flat.max(axis=0))


def draw_section(axes, grid, cut):
    """The cells that the plane crosses, coloured by their mean ratio."""
    polygons, cells = section(grid, cut)
    # Pieces of curved cells have the edges of their own colour, lest light shines through between them.
    edges = {"edgecolors": "face", "linewidths": 0.25} if grid.curved else {"edgecolors": "0.15", "linewidths": 0.25}
    faces = PolyCollection(polygons, cmap=style.QUALITY_MAP, norm=QUALITY_RANGE, joinstyle="round", **edges)
    faces.set_array(grid.cell_data["mean_ratio"][cells])
    axes.add_collection(faces)
    if grid.curved:
        axes.add_collection(LineCollection(section_lines(grid, cut), colors="0.15", linewidths=0.25, capstyle="round"))
    frame(axes, window(grid, cut), boxed=False)
