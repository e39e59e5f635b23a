# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes with the same nodes and cells, and the errors of their solutions: what node movement that knows the solution
makes of them."""

import math

from ..results.rows import solves_itself
from ..results.smoothing import INITIAL
from .meshes import box_aspect, columns_of, draw_blocks, draw_mesh
from .planar_geometry import bounding_box

MOST_CELLS = 20000  # that are told from each other in a panel
MOST_COLUMNS = 3


def error_blocks(results, grids):
    """Returns mesh -> (title, [(caption, grid)]): the initial mesh, the one by the first method that does not solve,
    and the one with the smallest true H1 error among the solution-adaptive methods. A mesh without such methods is left
    out."""
    solving = [method for method in results.methods if solves_itself(results.iterations.select(method=method))]
    others = [method for method in results.methods if method not in solving]
    blocks = {}
    for mesh in dict.fromkeys(mesh for mesh, _ in grids):
        errors = {method: h1_error(results, mesh, method) for method in (INITIAL, *results.methods)}
        known = [method for method in solving if (mesh, method) in grids and not math.isnan(errors[method])]
        if not known or len(grids[(mesh, known[0])].cell_data["mean_ratio"]) > MOST_CELLS:
            continue
        shown = [INITIAL, *others[:1], min(known, key=errors.get)]
        blocks[mesh] = (results.title(mesh), [(caption_of(results, method, errors[method], grids[(mesh, method)]),
                                               grids[(mesh, method)]) for method in shown if (mesh, method) in grids])
    return blocks


def h1_error(results, mesh, method):
    """The true one on the method's mesh, by elements of the lowest degree; NaN if it is not known."""
    rows = results.summary.select(mesh=mesh, method=method, degree=results.degrees[0] if results.degrees else "")
    return rows.number("h1_error")[0] if len(rows) else math.nan


def caption_of(results, method, error, grid):
    """Whose mesh, what error, what quality."""
    quality = grid.cell_data["mean_ratio"].mean()
    return rf"{results.title(method)}: $H^1$ error {error:.3g}, $q_\mathrm{{mean}}$ {quality:.3f}"


def draw_error_meshes(block):
    """A figure of whole meshes side by side."""
    return draw_blocks([block], columns_of([block], MOST_COLUMNS), box_aspect(block[1][0][1]),
                       lambda axes, grid, _: draw_mesh(axes, grid, bounding_box(grid)))
