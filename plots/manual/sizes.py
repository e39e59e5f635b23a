# SPDX-License-Identifier: GPL-3.0-or-later
"""Sizes of the studies in results/reference."""

import numpy as np

from ..results.rows import read_rows
from ..results.smoothing import read_provenance


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
