# SPDX-License-Identifier: GPL-3.0-or-later
"""The published gears, and the flange: blocks of the short answer."""

from .blocks import table
from .reference import PERCENT, factor, of_study, spread


def bad_meshes(reference):
    """Factors on the published gears and on the flange: true errors, interpolated ones, iterations."""
    gear, volume = of_study(reference, "gear"), of_study(reference, "volume")
    rows = []
    for name, study, mesh in (("gear, triangles", gear, "tri"), ("gear, quadrilaterals", gear, "quad"),
                              ("flange, tetrahedra", volume, "tet"), ("flange, hexahedra", volume, "hex")):
        quality = float(study[mesh, "1", "initial"]["q_mean"])
        for degree in "12":
            rows.append((name, f"{quality:.2f}", degree, *(f"{factor(study, mesh, degree, column):.1f}" for column in (
                "h1_error", "e_h1", "cg_iterations", "jacobi_cg_iterations"))))
    return ("Initial over GETMe (`results/reference/gear`, published meshes; `results/reference/volume`, stand-in meshes):\n\n"
            + table(("mesh", "q_mean before", "degree", "true H1 error", "e_H1 of the thesis", "CG iterations", "with Jacobi"),
                    rows, "lrrrrrr") + "\n\n" + weighted_laplace(gear))


def weighted_laplace(gear):
    """Where area-weighted Laplace has the lowest true H1 error of the published gears."""
    cases = [(mesh, degree) for mesh in ("tri", "quad") for degree in "12"]
    best = [min((float(row["h1_error"]), method) for (name, d, method), row in gear.items() if (name, d) == case)[1] for case in cases]
    lower = [PERCENT * (1 - factor(gear, *case, "h1_error", "getme", "weighted-laplace")) for case in cases]
    minima = [" and ".join(f"{float(gear[mesh, '1', method]['q_min']):.2f}" for mesh in ("tri", "quad")) for method in ("weighted-laplace", "getme")]
    return (f"On the gears area-weighted Laplace has the lowest true H1 error of all methods in {best.count('weighted-laplace')} of {len(cases)} cases. "
            f"It is {spread(lower, '.1f')} % below that of GETMe. Its `q_min` is {minima[0]} (triangles, quadrilaterals), that of GETMe {minima[1]}.")


def clusters(reference):
    """What smart Laplace and weighted Laplace do on the published gears."""
    gear = of_study(reference, "gear")
    worst = max((1 / factor(gear, mesh, degree, "h1_error", "smart-laplace", "getme"), mesh, degree)
                for mesh in ("tri", "quad") for degree in "12")
    where = {"tri": "triangles", "quad": "quadrilaterals"}[worst[1]]
    counts = [int(gear["tri", "1", method]["cg_iterations"]) for method in ("smart-laplace", "getme")]
    return (f"On the published gears smart Laplace keeps bad clusters of cells: up to {worst[0]:.1f} times GETMe's error ({where}, degree {worst[2]}), "
            f"and {counts[0]:,} CG iterations in place of {counts[1]:,} (triangles, degree 1; `results/reference/gear`).")


def minimum(reference):
    """The lowest quality and the error: smart Laplace's triangles of the gear."""
    gear = of_study(reference, "gear")
    smart, getme = gear["tri", "1", "smart-laplace"], gear["tri", "1", "getme"]
    higher = sorted(PERCENT * (factor(gear, "tri", degree, "h1_error", "getme", "smart-laplace") - 1) for degree in "12")
    condition = sorted(factor(gear, "tri", degree, "condition_number", "getme", "smart-laplace") for degree in "12")
    return (f"Smart Laplace's triangles of the gear keep q_min {float(smart['q_min']):.0e}. Their true H1 error is {higher[0]:.0f} to "
            f"{higher[1]:.0f} % above that of GETMe's (q_min {float(getme['q_min']):.2f}), and their condition number is "
            f"{condition[0]:,.0f} to {condition[1]:,.0f} times as high (`results/reference/gear`).")
