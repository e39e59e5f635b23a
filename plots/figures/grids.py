# SPDX-License-Identifier: GPL-3.0-or-later
"""The meshes of a study, by what can be drawn of them."""

import numpy as np

from ..results.method_styles import sequential_name
from ..results.smoothing import INITIAL
from ..results.vtu import NoVtk, read_vtu


def read_grids(results, report):
    """Returns (mesh, method) -> grid for all available meshes, in the order of the study: planar, volume and surface
    meshes. `report` takes a sentence for each mesh that is left out; without VTK, all are."""
    try:
        return sorted_grids(results, report)
    except NoVtk as error:
        report(f"No pictures of meshes: {error}.")
        return {}, {}, {}


def sorted_grids(results, report):
    """Like read_grids, but raises NoVtk."""
    planar, volume, surface, missing, unknown = {}, {}, {}, [], []
    failed = results.failures
    for mesh in results.meshes:
        for method in (INITIAL, *results.methods):
            if (mesh, method) in failed:  # its file has the initial mesh
                continue
            path = results.mesh_file(mesh, method)
            if not path.exists():
                missing.append(path.name)
                continue
            grid = read_vtu(path)
            if same_as_sequential(grid, {**planar, **volume, **surface}, mesh, method):
                continue
            kind = (planar if grid.is_planar else volume if grid.is_volume else
                    surface if grid.is_surface else None)
            if kind is None or "mean_ratio" not in grid.cell_data:
                unknown.append(path.name)
            else:
                kind[mesh, method] = grid
    if failed:
        report(f"Not drawn, because the method failed: {', '.join(f'{method} on {mesh}' for mesh, method in failed)}.")
    for names, reason in ((missing, "are missing"),
                          (unknown, "have cells of other kinds or lack `mean_ratio`")):
        if names:
            report(f"Not drawn, because meshes {reason}: {', '.join(names)}.")
    return planar, volume, surface


def same_as_sequential(grid, found, mesh, method):
    """True if the mesh of a parallel run is bitwise identical to the one of the sequential run: then it is shown
    once."""
    twin = found.get((mesh, sequential_name(method)))
    return (method != sequential_name(method) and twin is not None
            and np.array_equal(twin.points, grid.points))
