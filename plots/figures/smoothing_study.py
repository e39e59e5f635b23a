# SPDX-License-Identifier: GPL-3.0-or-later
"""Selection and names of the figures of meshes of a study, and the data they need."""

from ..results.smoothing import INITIAL
from .element_types import draw_element_types, is_mixed
from .error_meshes import draw_error_meshes, error_blocks
from .grids import read_grids
from .histograms import draw_histogram_differences, draw_histograms
from .meshes import (DETAIL_CENTRE, DETAIL_WIDTH, MOST_COLUMNS as PLANAR_COLUMNS, columns_of,
                     draw_meshes)
from .model import draw_model
from .pages import DISTORTED_SUFFIX, fits_as_columns, pages, pages_of_blocks
from .plane_sections import draw_plane_sections, is_coarse
from .planned import PlannedFigure
from .sections import MOST_COLUMNS as SECTION_COLUMNS, draw_sections, first_grid
from .solid import draw_solid
from .surfaces import MOST_COLUMNS as SURFACE_COLUMNS, draw_surfaces
from .thesis_numbers import figure_name


def plan_mesh_figures(results, report):
    """All figures that need meshes, which are read. `report` takes a sentence for whatever has to be
    left out."""
    planned = []

    def plan(draw, kind, variant, title, rendered=False, part="", suffix=""):
        study = results.thesis_study
        planned.append(PlannedFigure(figure_name(study, kind, suffix + part + variant), title, draw,
                                     rendered, figure_name(study, kind, suffix + variant)))

    planar, volume, surface = read_grids(results, report)
    if planar:
        plan_planar_figures(results, planar, plan, report)
    if volume:
        # A study of both kinds has two figures of each sort.
        plan_volume_figures(results, volume, plan, report, "_volume" if planar else "")
    if surface:
        blocks = blocks_of(results, surface)
        for part, shown in pages_of_blocks(blocks, columns_of(blocks.values(), SURFACE_COLUMNS)).items():
            plan(lambda shown=shown: draw_surfaces(shown), "meshes", "", "meshes", True, part)
    if planar or volume or surface:
        plan_histograms(results, {**planar, **volume, **surface}, plan)
    return planned


def plan_histograms(results, grids, plan):
    """Plans histograms of the mean ratio with linear and logarithmic counts, and of the change by distortion."""
    qualities = {key: grid.cell_data["mean_ratio"] for key, grid in grids.items()}
    meshes = [mesh for mesh in results.meshes if any(mesh == name for name, _ in qualities)]
    pairs = [(mesh, mesh + DISTORTED_SUFFIX) for mesh in meshes if mesh + DISTORTED_SUFFIX in meshes]
    for part, shown in pages(meshes, fits_as_columns).items():
        for logarithmic, variant in ((False, ""), (True, "_log")):
            plan(lambda shown=shown, logarithmic=logarithmic:
                 draw_histograms(results, shown, qualities, logarithmic),
                 "histograms", variant, "histograms of quality", part=part)
    for part, shown in pages([mesh for mesh, _ in pairs], fits_as_columns).items():
        chosen = [pair for pair in pairs if pair[0] in shown]
        if chosen:
            plan(lambda chosen=chosen: draw_histogram_differences(results, chosen, qualities),
                 "histogram_differences", "", "what distortion changes", part=part)


def solved_grid(results, grids, report):
    """The mesh that shows the exact solution best; None without one."""
    solved = [(mesh, grid) for (mesh, _), grid in grids.items() if "exact_solution" in grid.point_data]
    if not solved:
        if not results.degrees:
            return None
        report("No figure of the model: no mesh has the point data `exact_solution`.")
        return None
    # The last method's mesh: interpolation on a distorted one is coarse.
    return [grid for mesh, grid in solved if mesh == solved[0][0]][-1]


def figure_settings(results):
    """The study's own settings for figures, if it has any."""
    settings = results.provenance.get("figures")
    return settings if isinstance(settings, dict) else {}


def blocks_of(results, grids):
    """Mesh -> (title, panels), one per method."""
    return {mesh: (results.title(mesh), [(results.title(method), grid)
                                         for (name, method), grid in grids.items() if name == mesh])
            for mesh in dict.fromkeys(mesh for mesh, _ in grids)}


def plan_planar_figures(results, grids, plan, report):
    """The figures of the model and of the meshes."""
    grid = solved_grid(results, grids, report)
    if grid is not None:
        plan(lambda: draw_model(grid), "model", "", "model and exact solution")
    blocks = blocks_of(results, grids)
    settings = figure_settings(results)
    detail = (settings.get("detail_centre", DETAIL_CENTRE), settings.get("detail_width", DETAIL_WIDTH))
    columns = columns_of(blocks.values(), PLANAR_COLUMNS, with_free=True)
    for part, shown in pages_of_blocks(blocks, columns).items():
        for variant, window in (("", detail), ("_full", None)):
            plan(lambda shown=shown, window=window: draw_meshes(shown, window), "meshes", variant,
                 "meshes" if window is None else "details of the meshes", part=part)
    errors = error_blocks(results, grids)
    for mesh, block in errors.items():
        plan(lambda block=block: draw_error_meshes(block), "meshes_errors", "", "meshes and the errors on them",
             part=f"_{mesh}" if len(errors) > 1 else "")


def plan_volume_figures(results, grids, plan, report, suffix):
    """Plans the figures of volume meshes, cut open, and of the types of their cells in mixed meshes."""
    normal = figure_settings(results).get("cut_normal")
    # Methods without any mesh have no panel; one that is missing of some meshes has an empty one.
    methods = [m for m in (INITIAL, *results.methods) if any(m == method for _, method in grids)]
    blocks = {mesh: (results.title(mesh), [(results.title(method), grids.get((mesh, method)))
                                           for method in methods])
              for mesh in dict.fromkeys(mesh for mesh, _ in grids)}
    grid = solved_grid(results, grids, report)
    if grid is not None:
        plan(lambda: draw_solid(grid), "model", suffix, "model and exact solution", True)
    for part, shown in pages_of_blocks(blocks, columns_of(blocks.values(), SECTION_COLUMNS)).items():
        for variant, detail in (("", False), ("_detail", True)):
            plan(lambda shown=shown, detail=detail: draw_sections(shown, detail, normal),
                 "meshes", variant, "details of the cut meshes" if detail else "cut meshes", True, part,
                 suffix)
    coarse = [mesh for mesh, (_, panels) in blocks.items() if is_coarse(first_grid(panels))]
    for mesh in coarse:
        part = f"_{mesh}" if len(coarse) > 1 else ""
        plan(lambda mesh=mesh: draw_plane_sections(*blocks[mesh]), "plane_sections", "",
             "sections by planes", True, part, suffix)
    mixed = [(title, panels_of_types(panels)) for title, panels in blocks.values()
             if is_mixed(first_grid(panels))]
    if mixed:
        plan(lambda: draw_element_types(mixed, normal), "element_types", suffix, "types of elements", True)


def panels_of_types(panels):
    """The first and the last mesh of a block: thin layers are better seen after smoothing."""
    there = [panel for panel in panels if panel[1] is not None]
    return there[:1] + there[1:][-1:]
