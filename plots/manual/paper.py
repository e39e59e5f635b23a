# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of paper/paper.md."""

from ..results.rows import read_rows

MESHES = (("tri", "triangles"), ("quad", "quadrilaterals"))


def gear(reference):
    """The published gears before and after GETMe, as sentences."""
    rows = {(row["mesh"], row["degree"], row["method"]): row for row in read_rows(reference / "gear" / "summary.csv").records()}
    return "\n".join(of_mesh(name, *({degree: rows[mesh, degree, method] for degree in "12"} for method in ("initial", "getme")))
                     for mesh, name in MESHES)


def of_mesh(name, before, after):
    """Qualities, and errors and iterations before over after. before, after: {degree: record}."""
    quality = [float(found["1"]["q_mean"]) for found in (before, after)]
    error, iterations = ([float(before[degree][column]) / float(after[degree][column]) for degree in "12"]
                         for column in ("h1_error", "cg_iterations"))
    return (f"On the published gear of {name}, GETMe raises the mean quality from {quality[0]:.2f} to {quality[1]:.2f}. It divides the true H1 error "
            f"by {error[0]:.1f} with linear elements and by {error[1]:.1f} with quadratic elements. It divides the iterations of CG "
            f"without preconditioner by {iterations[0]:.0f} and {iterations[1]:.0f}.")
