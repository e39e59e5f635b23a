# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of paper/paper.md."""

from .reference import factor, of_study

MESHES = (("tri", "triangles"), ("quad", "quadrilaterals"))


def gear(reference):
    """The published gears before and after GETMe, as sentences."""
    rows = of_study(reference, "gear")
    return "\n".join(of_mesh(rows, mesh, name) for mesh, name in MESHES)


def of_mesh(rows, mesh, name):
    """Qualities, and errors and iterations before over after."""
    quality = [float(rows[mesh, "1", method]["q_mean"]) for method in ("initial", "getme")]
    error, iterations = ([factor(rows, mesh, degree, column) for degree in "12"] for column in ("h1_error", "cg_iterations"))
    return (f"On the published gear of {name}, GETMe raises the mean quality from {quality[0]:.2f} to {quality[1]:.2f}. It divides the true H1 error "
            f"by {error[0]:.1f} with linear elements and by {error[1]:.1f} with quadratic elements. It divides the iterations of CG "
            f"without preconditioner by {iterations[0]:.0f} and {iterations[1]:.0f}.")
