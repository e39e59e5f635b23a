# SPDX-License-Identifier: GPL-3.0-or-later
"""Which figures belong to a study, what they are called, and what they need."""

from . import style
from .figure_history import draw_history
from .figure_meshes import DETAIL_CENTRE, DETAIL_WIDTH, draw_meshes, rows_of_panels
from .figure_model import draw_model
from .read_results import INITIAL
from .read_vtu import read_vtu

# Numbers in the thesis of the figures of its studies; any other figure has no number.
THESIS_NUMBERS = {"gear": {"model": "6_2", "meshes": "6_3", "history": "6_4"}}

# Rows of panels that fit a page; with more of them each mesh gets figures of its own.
ROWS_OF_A_PAGE = 4


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

    grids = read_planar_grids(results, report)
    if grids:
        draw_mesh_figures(results, grids, save, report)
    first = results.degrees[0] if results.degrees else ""
    main = ("q_min", "q_mean", "e_max", "e_mean")
    for log_time, variant, title in ((False, "", "history"), (True, "_log_time", "history, log time")):
        save(draw_history(results, main, first, log_time),
             figure_name(results.study, "history", variant), title)
    for degree in results.degrees:
        # Not figure_6_4_...: the thesis has these for the lowest degree only, and no true errors.
        prefix = "figure_history" if results.study in THESIS_NUMBERS else "history"
        if degree != first:
            save(draw_history(results, main, degree), f"{prefix}_d{degree}", f"history, d = {degree}")
        save(draw_history(results, ("e_l2", "e_h1", "l2_error", "h1_error"), degree),
             f"{prefix}_norms_d{degree}", f"error norms, d = {degree}")
    return paths


def read_planar_grids(results, report):
    """(mesh, method) -> grid for all planar meshes that are there, in the order of the study."""
    grids, missing, not_planar = {}, [], []
    for mesh in results.meshes:
        for method in (INITIAL, *results.methods):
            path = results.mesh_file(mesh, method)
            if not path.exists():
                missing.append(path.name)
                continue
            grid = read_vtu(path)
            if grid.is_planar and "mean_ratio" in grid.cell_data:
                grids[mesh, method] = grid
            else:
                not_planar.append(path.name)
    for names, reason in ((missing, "are missing"), (not_planar, "are not planar or lack `mean_ratio`")):
        if names:
            report(f"Not drawn, because meshes {reason}: {', '.join(names)}.")
    return grids


def draw_mesh_figures(results, grids, save, report):
    """The figures of the model and of the meshes."""
    # The exact solution is shown on the last method's mesh: interpolation on a distorted one is coarse.
    solved = [(mesh, grid) for (mesh, _), grid in grids.items() if "exact_solution" in grid.point_data]
    if solved:
        grid = [grid for mesh, grid in solved if mesh == solved[0][0]][-1]
        save(draw_model(grid), figure_name(results.study, "model"), "model and exact solution")
    else:
        report("No figure of the model: no mesh has the point data `exact_solution`.")
    names = list(dict.fromkeys(mesh for mesh, _ in grids))
    blocks = [(results.title(mesh), [(results.title(method), grid)
                                     for (name, method), grid in grids.items() if name == mesh])
              for mesh in names]
    settings = results.provenance.get("figures")
    settings = settings if isinstance(settings, dict) else {}
    detail = (settings.get("detail_centre", DETAIL_CENTRE), settings.get("detail_width", DETAIL_WIDTH))
    parts = {"": blocks}
    if sum(rows_of_panels(panels) for _, panels in blocks) > ROWS_OF_A_PAGE:
        parts = {f"_{name}": [block] for name, block in zip(names, blocks)}
    for part, shown in parts.items():
        for variant, window in (("", detail), ("_full", None)):
            save(draw_meshes(shown, window), figure_name(results.study, "meshes", part + variant),
                 "meshes" if window is None else "details of the meshes")
