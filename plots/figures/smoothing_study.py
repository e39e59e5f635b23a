# SPDX-License-Identifier: GPL-3.0-or-later
"""Which figures belong to a study, what they are called, and what they need."""

from ..results.smoothing import INITIAL
from . import style
from .element_types import draw_element_types, is_mixed
from .grids import read_grids
from .histograms import draw_histogram_differences, draw_histograms
from .history import draw_history
from .meshes import (DETAIL_CENTRE, DETAIL_WIDTH, MOST_COLUMNS as PLANAR_COLUMNS, columns_of,
                     draw_meshes)
from .model import draw_model
from .pages import DISTORTED_SUFFIX, draw_pages, fits_as_columns, pages
from .plane_sections import draw_plane_sections, is_coarse
from .sections import MOST_COLUMNS as SECTION_COLUMNS, draw_sections, first_grid
from .solid import draw_solid
from .surfaces import MOST_COLUMNS as SURFACE_COLUMNS, draw_surfaces
from .virtual_display import NoDisplay

# Numbers in the thesis of the figures of its studies; any other figure has no number.
THESIS_NUMBERS = {
    "planar": {"meshes": "5_2"},
    "surface": {"meshes": "5_4"},
    "bridge": {"meshes": "5_6"},
    "sphere": {"meshes": "5_7", "history": "5_8", "histograms": "5_9"},
    "prosthesis": {"meshes": "5_11", "history": "5_12", "histograms": "5_13"},
    "axle": {"meshes": "5_15", "history": "5_16"},
    "nonuniform-grid": {"plane_sections": "5_18", "history": "5_19"},
    "subdivision": {"meshes": "5_21", "histograms": "5_22", "history": "5_23"},
    "sweep": {"meshes": "5_25", "histograms": "5_26", "history": "5_27"},
    "car": {"meshes": "5_31", "histograms": "5_30", "histogram_differences": "5_33",
            "history": "5_34"},
    "plate": {"element_types": "5_35", "meshes": "5_36", "histograms": "5_37", "history": "5_38"},
    "ring": {"element_types": "5_39", "meshes": "5_40", "histograms": "5_41", "history": "5_42"},
    "aorta": {"element_types": "5_43", "meshes": "5_44", "histograms": "5_45", "history": "5_46"},
    "warpage": {"history": "5_47"},
    "piston": {"meshes": "5_49", "history": "5_50"},
    "pump": {"meshes": "5_52", "history": "5_53"},
    "gear": {"model": "6_2", "meshes": "6_3", "history": "6_4"},
    "volume": {"model": "6_5", "meshes": "6_6", "histograms": "6_7", "history": "6_8"}}
# The degree whose errors the history figure shows; the lowest one for any other study.
HISTORY_DEGREES = {"volume": "2"}


def figure_name(study, kind, variant=""):
    """The file name without suffix: figure_6_4_history_log_time, or history_log_time."""
    numbers = THESIS_NUMBERS.get(study)
    if numbers is None:
        return kind + variant
    return "_".join(["figure"] + ([numbers[kind]] if kind in numbers else []) + [kind]) + variant


def draw_figures(results, report):
    """Draws all figures into <folder>/figures; returns the paths. `report` takes a sentence for
    whatever had to be left out."""
    style.apply_style()
    paths = []

    def save(figure, name, title):
        if figure is not None:
            paths.extend(style.save_figure(figure, results.folder / "figures", name,
                                           f"{results.study_title}: {title}"))

    planar, volume, surface = read_grids(results, report)
    if planar:
        draw_mesh_figures(results, planar, save, report)
    if volume:
        # A study of both kinds has two figures of each sort.
        draw_volume_figures(results, volume, save, report, "_volume" if planar else "")
    if surface:
        draw_surface_figures(results, surface, save, report)
    if planar or volume or surface:
        draw_histogram_figures(results, {**planar, **volume, **surface}, save)
    draw_history_figures(results, save)
    return paths


def draw_histogram_figures(results, grids, save):
    """How many cells of which quality there are, with linear and logarithmic counts, and what
    distortion changes in that."""
    qualities = {key: grid.cell_data["mean_ratio"] for key, grid in grids.items()}
    meshes = [mesh for mesh in results.meshes if any(mesh == name for name, _ in qualities)]
    pairs = [(mesh, mesh + DISTORTED_SUFFIX) for mesh in meshes if mesh + DISTORTED_SUFFIX in meshes]
    for part, shown in pages(meshes, fits_as_columns).items():
        for logarithmic, variant in ((False, ""), (True, "_log")):
            save(draw_histograms(results, shown, qualities, logarithmic),
                 figure_name(results.study, "histograms", part + variant), "histograms of quality")
    for part, shown in pages([mesh for mesh, _ in pairs], fits_as_columns).items():
        chosen = [pair for pair in pairs if pair[0] in shown]
        if chosen:
            save(draw_histogram_differences(results, chosen, qualities),
                 figure_name(results.study, "histogram_differences", part), "what distortion changes")


def draw_history_figures(results, save):
    """Quality and errors against smoothing time, for each degree."""
    first = results.degrees[0] if results.degrees else ""
    shown = HISTORY_DEGREES.get(results.study, first)
    shown = shown if shown in results.degrees else first
    main = (("q_min", "q_mean", "e_max", "e_mean") if results.degrees else
            ("q_star_min", "q_mean", "w_mean"))
    for part, meshes in pages(results.meshes, fits_as_columns).items():
        def draw(columns, degree, name, title, log_time=False):
            save(draw_history(results, columns, degree, log_time, meshes), name, title)
        for log_time, variant, title in ((False, "", "history"),
                                         (True, "_log_time", "history, log time")):
            draw(main, shown, figure_name(results.study, "history", part + variant), title, log_time)
        for degree in results.degrees:
            # Without number: the thesis has these for one degree only, and no true errors.
            prefix = ("figure_history" if results.study in THESIS_NUMBERS else "history") + part
            if degree != shown:
                draw(main, degree, f"{prefix}_d{degree}", f"history, d = {degree}")
            draw(("e_l2", "e_h1", "l2_error", "h1_error"), degree, f"{prefix}_norms_d{degree}",
                 f"error norms, d = {degree}")


def solved_grid(results, grids, report):
    """The mesh that shows the exact solution best; None if there is none."""
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


def draw_surface_figures(results, grids, save, report):
    """The meshes of surfaces, as a whole."""
    blocks = blocks_of(results, grids)

    def draw(part, shown):
        save(draw_surfaces(shown), figure_name(results.study, "meshes", part), "meshes")
    try:
        draw_pages(blocks, columns_of(blocks.values(), SURFACE_COLUMNS), draw)
    except NoDisplay as error:
        report(f"No pictures of surface meshes: {error}.")


def draw_mesh_figures(results, grids, save, report):
    """The figures of the model and of the meshes."""
    grid = solved_grid(results, grids, report)
    if grid is not None:
        save(draw_model(grid), figure_name(results.study, "model"), "model and exact solution")
    blocks = blocks_of(results, grids)
    settings = figure_settings(results)
    detail = (settings.get("detail_centre", DETAIL_CENTRE), settings.get("detail_width", DETAIL_WIDTH))

    def draw(part, shown):
        for variant, window in (("", detail), ("_full", None)):
            save(draw_meshes(shown, window), figure_name(results.study, "meshes", part + variant),
                 "meshes" if window is None else "details of the meshes")
    draw_pages(blocks, columns_of(blocks.values(), PLANAR_COLUMNS, with_free=True), draw)


def draw_volume_figures(results, grids, save, report, suffix):
    """The same for volume meshes, cut open, and the types of their cells where they are mixed."""
    normal = figure_settings(results).get("cut_normal")
    # Methods without any mesh have no panel; one that is missing of some meshes has an empty one.
    methods = [m for m in (INITIAL, *results.methods) if any(m == method for _, method in grids)]
    blocks = {mesh: (results.title(mesh), [(results.title(method), grids.get((mesh, method)))
                                           for method in methods])
              for mesh in dict.fromkeys(mesh for mesh, _ in grids)}

    def draw(part, shown):
        for variant, detail in (("", False), ("_detail", True)):
            save(draw_sections(shown, detail, normal),
                 figure_name(results.study, "meshes", suffix + part + variant),
                 "details of the cut meshes" if detail else "cut meshes")
    try:
        grid = solved_grid(results, grids, report)
        if grid is not None:
            save(draw_solid(grid), figure_name(results.study, "model", suffix),
                 "model and exact solution")
        draw_pages(blocks, columns_of(blocks.values(), SECTION_COLUMNS), draw)
        coarse = [mesh for mesh, (_, panels) in blocks.items() if is_coarse(first_grid(panels))]
        for mesh in coarse:
            part = f"_{mesh}" if len(coarse) > 1 else ""
            save(draw_plane_sections(*blocks[mesh]),
                 figure_name(results.study, "plane_sections", suffix + part), "sections by planes")
        mixed = [(title, panels_of_types(panels)) for title, panels in blocks.values()
                 if is_mixed(first_grid(panels))]
        if mixed:
            save(draw_element_types(mixed, normal),
                 figure_name(results.study, "element_types", suffix), "types of elements")
    except NoDisplay as error:
        report(f"No pictures of volume meshes: {error}.")


def panels_of_types(panels):
    """The first and the last mesh of a block: thin layers are better seen after smoothing."""
    there = [panel for panel in panels if panel[1] is not None]
    return there[:1] + there[1:][-1:]
