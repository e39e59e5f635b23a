# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that were published before and after another program's optimization: NAME_in and NAME_out."""

import numpy as np

from ..results.rows import groups_of
from ..results.smoothing import INITIAL
from .columns import number, table_of
from .table import number_cell, text_cell

BEFORE, AFTER = "_in", "_out"


def model_of(mesh, side):
    """The name of the model; None for meshes of another name."""
    return mesh[:-len(side)] if mesh.endswith(side) and len(mesh) > len(side) else None


def pairs_table(results):
    """For each model: quality and errors of the mesh before, as smoothed by each method, and after. Without rows where no model has both
    meshes."""
    rows = results.summary.where(results.summary.text("degree") != "")
    meshes = [member.removesuffix(f".{solution}") for member, solution in zip(rows.text("member"), rows.text("solution"))]
    sides = {side: np.array([model_of(mesh, side) or "" for mesh in meshes], dtype=object) for side in (BEFORE, AFTER)}
    models = sorted(set(sides[BEFORE]) & set(sides[AFTER]) - {""})
    problems = [key for key, _ in groups_of(rows, "solution", "degree")]
    lines = [(model, side, method) for model in models
             for side, method in ((BEFORE, INITIAL), *((BEFORE, method) for method in results.methods), (AFTER, INITIAL))]
    of_line = [rows.where((sides[side] == model) & (rows.text("method") == method)) for model, side, method in lines]

    def title(side, method):
        return "as published, after" if side == AFTER else "before" if method == INITIAL else f"before, {results.title(method)}"

    def first(chosen, column):
        return chosen.number(column)[0] if len(chosen) else np.nan

    def errors(solution, degree):
        found = [first(chosen.select(solution=solution, degree=degree), "h1_error") for chosen in of_line]
        return [number(error, ".4g") for error in found]
    return table_of(
        results, "table_published_pairs", "published meshes before and after another program",
        [("Model", [text_cell(model) for model, _, _ in lines]),
         ("Mesh", [text_cell(title(side, method)) for _, side, method in lines])],
        [("q_min", [("", [number(first(chosen, "q_min"), ".3f") for chosen in of_line])]),
         ("q_mean", [("", [number(first(chosen, "q_mean"), ".3f") for chosen in of_line])]),
         ("Invalid cells", [("", [number_cell(f"{first(chosen, 'n_invalid'):.0f}" if len(chosen) else "") for chosen in of_line])]),
         *((f"H1 error, {solution}" if solution else "H1 error", [(f"d = {degree}", errors(solution, degree))])
           for solution, degree in problems)],
        ["A model has two published meshes: NAME_in, before, and NAME_out, which another program has made of it. Before: a tangled mesh is "
         "the one after untangling. Methods smooth this mesh, and keep its boundary; the other program also moves nodes of the boundary, "
         "so that the two domains differ a little. A dash: no result, or one with invalid cells."])
