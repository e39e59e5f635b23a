# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a results folder: CSV rows, provenance, names of mesh files.

Columns are documented in results/README.md.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .rows import ResultsError, Rows, entries, order_of, read_provenance, read_rows

# What tables and figures cannot do without; any other column may be absent and then counts as empty.
REQUIRED_COLUMNS = {
    "iterations.csv": ("mesh", "method", "iteration", "smoothing_seconds", "q_min", "q_mean",
                       "n_invalid", "degree", "e_max", "e_mean"),
    "summary.csv": ("mesh", "method", "iterations", "smoothing_seconds", "q_min", "q_mean",
                    "degree", "condition_number", "cg_iterations", "cg_seconds",
                    "e_max", "e_mean", "e_l2", "e_h1"),
    "thresholds.csv": ("mesh", "degree", "error", "threshold", "reference_method",
                       "reference_seconds", "method", "method_seconds", "speedup"),
}

INITIAL = "initial"


@dataclass(frozen=True)
class Results:
    """One results folder. Titles map names to what a reader sees; orders are those of the study."""

    folder: Path
    study: str
    study_title: str
    meshes: tuple
    methods: tuple  # without the initial mesh
    degrees: tuple  # as strings, as in the file
    titles: dict
    summary: Rows
    iterations: Rows
    thresholds: Rows
    provenance: dict

    @property
    def note(self):
        """What the study says about comparing its numbers with the thesis; may be empty."""
        return str(self.provenance.get("note") or "")

    def title(self, name):
        """The title of a mesh or method; its name where the provenance gives none."""
        return self.titles.get(name, name)

    def mesh_file(self, mesh, method):
        """Path of the mesh that the method ended with (it need not exist)."""
        return self.folder / "meshes" / f"{mesh}_{method}.vtu"

    def is_published(self, mesh):
        """Whether the provenance calls the mesh one of the published ones."""
        return any(entry.get("name") == mesh and entry.get("published") is True
                   for entry in entries(self.provenance, "meshes"))


def read_results(folder):
    """Reads a results folder. summary.csv and iterations.csv must be there; thresholds.csv and
    provenance.json may be absent. Raises ResultsError with one sentence on what is wrong."""
    folder = Path(folder)
    if not folder.is_dir():
        raise ResultsError(f"{folder}: there is no such folder.")
    summary = read_rows(folder / "summary.csv", REQUIRED_COLUMNS["summary.csv"])
    iterations = read_rows(folder / "iterations.csv", REQUIRED_COLUMNS["iterations.csv"])
    if not len(summary) or not len(iterations):
        empty = summary if not len(summary) else iterations
        raise ResultsError(f"{empty.path}: the file has no rows.")
    required = REQUIRED_COLUMNS["thresholds.csv"]
    path = folder / "thresholds.csv"
    if path.exists():
        thresholds = read_rows(path, required)
    else:
        thresholds = Rows(path, {name: np.array([], dtype=object) for name in required})
    provenance = read_provenance(folder / "provenance.json")
    study = str(provenance.get("study") or summary.text("study")[0] or folder.resolve().name)
    titles = {INITIAL: "Initial"}
    for key in ("meshes", "methods"):
        titles.update({e["name"]: str(e["title"]) for e in entries(provenance, key) if e.get("title")})
    methods = order_of(summary.text("method"), provenance, "methods")
    return Results(
        folder=folder, study=study, study_title=str(provenance.get("study_title") or study),
        meshes=order_of(summary.text("mesh"), provenance, "meshes"),
        methods=tuple(method for method in methods if method != INITIAL),
        degrees=tuple(sorted({degree for degree in summary.text("degree") if degree}, key=float)),
        titles=titles, summary=summary, iterations=iterations, thresholds=thresholds,
        provenance=provenance)
