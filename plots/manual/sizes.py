# SPDX-License-Identifier: GPL-3.0-or-later
"""Sizes of the studies in results/reference."""

import numpy as np

from ..results.rows import read_rows
from ..results.smoothing import read_provenance
from ..tables.number_format import MISSING
from .blocks import table
from .reference import of_study

MESHES = {"tet": "tetrahedra", "hex": "hexahedra"}


def max_dofs(path):
    """The largest number of degrees of freedom in a summary.csv."""
    return int(np.nanmax(read_rows(path).number("n_dofs"), initial=0))


def largest(reference):
    """The largest system, and the time and size of the volume study, as Markdown."""
    dofs = max(max_dofs(path.parent / "summary.csv") for path in reference.glob("*/provenance.json"))
    run = read_provenance(reference / "volume" / "provenance.json")
    hours = sum(run["seconds"].values()) / 3600
    return (f"The largest system in `results/reference` has {dofs:,} degrees of freedom. The reference run of `volume` at the "
            f"scale `paper` has up to {max_dofs(reference / 'volume' / 'summary.csv'):,} degrees of freedom and took "
            f"{hours:.1f} hours with {run['sessions'][-1]['machine']['ranks']} processes.\n")


def huge(reference):
    """The study `volume` at the scale `huge`: size, time and a table of meshes and methods, as Markdown."""
    rows = of_study(reference, "volume-huge")
    run = read_provenance(reference / "volume-huge" / "provenance.json")
    dofs = {mesh: max(int(row["n_dofs"]) for (found, _, _), row in rows.items() if found == mesh and row["n_dofs"]) for mesh in MESHES}
    lines, notes = [], []
    for (mesh, _, method), row in rows.items():
        lines.append((MESHES[mesh], f"`{method}`", shown(row["smoothing_seconds"], ".1f"), shown(row["q_min"], ".2g"),
                      shown(row["h1_error"], ".4g"), *(shown(row[column], ",.0f") for column in ("cg_iterations", "jacobi_cg_iterations"))))
        if row["status"] != "ok":
            notes.append(f"- {MESHES[mesh]}, `{method}`: {row['status'].strip()}")
    minutes = sum(run["seconds"].values()) / 60
    return (f"`smoothfem study volume --scale huge` took {minutes:.0f} minutes on {run['sessions'][-1]['machine']['ranks']} processes "
            f"(`results/reference/volume-huge`). It has {dofs['tet']:,} degrees of freedom on tetrahedra and {dofs['hex']:,} on hexahedra:\n\n"
            + table(("mesh", "method", "smoothing, s", "q_min", "true H1 error", "CG iterations", "with Jacobi"), lines, "llrrrrr")
            + "\n\n" + "\n".join(notes))


def shown(number, form):
    """A number of a row as a text; a dash if it is missing."""
    return f"{float(number):{form}}" if number else MISSING
