# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of the page on finite elements: errors by CG and by the space, and the time of Gauss points."""

from ..results.rows import entries
from ..results.smoothing import read_provenance
from .blocks import table
from .reference import PERCENT, factor, of_study, spread


def blocks(reference):
    """The blocks of the page."""
    return {"converged": converged(reference), "best": space_part(reference), "points": points_of_hexahedra(reference)}


def converged(reference):
    """What CG's stopping changes in the errors of the published gears: the page on finite elements."""
    stopped, exact = of_study(reference, "gear"), of_study(reference, "reasons/gear-converged")

    def largest(method, column):
        return max(abs(float(stopped[mesh, degree, method][column]) / float(exact[mesh, degree, method][column]) - 1)
                   for mesh in ("tri", "quad") for degree in "12")
    found = {(method, column): f"{PERCENT * largest(method, column):.2g} %" for method in ("initial", "getme")
             for column in ("e_mean", "e_l2", "e_h1", "l2_error", "h1_error")}

    def told(method):
        return ", ".join(f"`{column}` {found[method, column]}" for column in ("e_mean", "e_l2", "e_h1", "l2_error", "h1_error"))
    return ("How much of an error is left by CG? On the published gears CG was run to a residual of 1e-13, too (`results/reference/reasons/"
            f"gear-converged`). The errors differ from those at 1e-8 by at most: {told('initial')} on the initial meshes; {told('getme')} on "
            "GETMe's meshes.")


def space_part(reference):
    """The true error over the least one on the published gears: the page on finite elements."""
    gear = of_study(reference, "gear")
    titles = {"initial": "initial", "getme": "GETMe", "global-optimization": "Global Optimization"}

    def over(mesh, degree, method):
        row = gear[mesh, degree, method]
        return float(row["h1_error"]) / float(row["h1_best"])
    rows = [(name, title, *(f"{float(gear[mesh, '1', method][column]):.1f}" for column in ("e_h1", "h1_error", "h1_best")),
             f"{over(mesh, '1', method):.3f}")
            for mesh, name in (("tri", "triangles"), ("quad", "quadrilaterals")) for method, title in titles.items()]
    second = [over(mesh, "2", method) for mesh in ("tri", "quad") for method in titles]
    return ("Published gears, degree 1 (`results/reference/gear`):\n\n"
            + table(("elements", "mesh", "`e_h1`", "`h1_error`", "`h1_best`", "`h1_error` / `h1_best`"), rows, "llrrrr")
            + f"\n\nAt degree 2 the quotients are {spread(second, '.4f')}.")


def points_of_hexahedra(reference):
    """What a rule for each cell costs on distorted hexahedra: the page on finite elements."""
    volume = of_study(reference, "volume")
    meshes = list(dict.fromkeys(mesh for mesh, _, _ in volume if mesh.startswith("hex")))
    longer = [factor(volume, mesh, degree, "assembly_seconds") for mesh in meshes for degree in "12"]
    runs = {mesh["name"]: mesh for mesh in entries(read_provenance(reference / "volume" / "provenance.json"), "meshes")}
    most = max(max(runs[mesh]["most_hexahedron_points"].values()) for mesh in meshes)
    return (f"This takes time on distorted meshes. In the study `volume` with `auto`, cells of the initial hexahedra get up to {most} points per direction. "
            f"Assembly then takes {spread(longer, '.0f')} times as long as on GETMe's mesh ({len(meshes)} seeds, degrees 1 and 2).")
