# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a results folder: CSV rows, provenance, names of mesh files.

Columns are documented in studies/columns.json.
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from .names import find_all
from .rows import ResultsError, Rows, entries, is_built_in, is_there, order_of, read_provenance, read_rows
from .seeds import by_seed
from .solvers import solvers_of
from .symbols import of_solver

# What tables and figures cannot do without; any other column may be absent and then counts as empty.
REQUIRED_COLUMNS = {
    "iterations.csv": ("mesh", "method", "iteration", "smoothing_seconds", "q_min", "q_mean",
                       "n_invalid", "degree", "e_max", "e_mean"),
    "summary.csv": ("mesh", "method", "iterations", "smoothing_seconds", "q_min", "q_mean",
                    "degree", "condition_number", "cg_iterations", "cg_seconds",
                    "e_max", "e_mean", "e_l2", "e_h1"),
    "thresholds.csv": ("mesh", "degree", "error", "threshold", "reference_method",
                       "reference_seconds", "method", "method_seconds", "speedup"),
    "solutions.csv": ("mesh", "method", "solution", "degree", "h1_error", "status"),
    "refined.csv": ("mesh", "method", "degree", "h1_error", "status"),
}

# Columns without whose numbers a row says nothing.
REQUIRED_NUMBERS = {"iterations.csv": ("iteration", "smoothing_seconds", "q_min", "q_mean", "n_invalid"),
                    "summary.csv": ("q_min", "q_mean"), "thresholds.csv": ("degree", "threshold"), "solutions.csv": (),
                    "refined.csv": ()}
# Columns that hold numbers, of any of the files.
NUMBERS = ("iteration", "smoothing_seconds", "q_min", "q_star_min", "q_mean", "n_invalid", "n_reset",
           "w_max", "w_mean", "peak_memory_gib", "degree", "n_dofs", "n_free", "assembly_seconds", "condition_number",
           "lambda_min", "lambda_max", "condition_residual", "jacobi_condition_number", "cg_iterations", "cg_seconds",
           "jacobi_cg_iterations", "jacobi_cg_seconds", "amg_cg_iterations", "amg_setup_seconds",
           "amg_cg_seconds", "e_max", "e_mean", "e_l2", "e_h1", "l2_error", "h1_error", "l2_best", "h1_best", "threshold",
           "reference_seconds", "method_seconds", "speedup", "n_solves", "method_solve_seconds")
# What tells the mesh of one record from that of another.
FINGERPRINT = ("q_min", "q_star_min", "q_mean", "n_invalid")

INITIAL = "initial"
FAILED = "failed: "  # how the status of a method begins that gave no mesh; the reason follows
QUICK = "quick"  # the scale that shows that everything works


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
    solutions: Rows = Rows(Path("solutions.csv"), {})  # of all solutions on initial and resulting meshes, if several
    refined: Rows = Rows(Path("refined.csv"), {})  # initial and resulting meshes with every cell split
    seeds: tuple = ()  # of the study's repetitions, that of these results first; empty: there are none
    repeated: tuple = ()  # the meshes that the seeds change
    repetitions: tuple = ()  # Results of the other seeds
    study_methods: tuple = ()  # all methods of the study, chosen or not: they decide on colours and marks

    @property
    def thesis_study(self):
        """By which name the thesis' numbers, figures and claims are about this study; empty for a
        study of the user's, whatever its name."""
        return self.study if is_built_in(self.provenance) else ""

    @property
    def is_quick(self):
        """True if the meshes are too coarse for conclusions."""
        return self.provenance.get("scale") == QUICK

    @property
    def failures(self):
        """(mesh, method) -> status, "failed: " and why, of the methods that gave no mesh."""
        rows = self.summary
        return {(mesh, method): status for mesh, method, status in zip(*map(rows.text, ("mesh", "method", "status")))
                if status.startswith(FAILED)}

    def without_failures(self):
        """The results of methods that gave a mesh: the numbers of the others are the initial mesh's."""
        failures = self.failures

        def rows_of(rows):
            pairs = zip(*map(rows.text, ("mesh", "method")))
            return rows.where(np.array([pair not in failures for pair in pairs], dtype=bool))
        return replace(self, summary=rows_of(self.summary), iterations=rows_of(self.iterations),
                       thresholds=rows_of(self.thresholds))

    @property
    def solvers(self):
        """The solvers besides Poisson's that have given a number."""
        return solvers_of(self.summary, self.provenance)

    @property
    def note(self):
        """The study's remark about comparing its numbers with the thesis; may be empty."""
        return str(self.provenance.get("note") or "")

    def title(self, name):
        """The title of a mesh or method; its name where the provenance gives none."""
        return self.titles.get(name, name)

    def mesh_file(self, mesh, method):
        """Path of the mesh that the method ended with (it need not exist)."""
        return self.folder / "meshes" / f"{mesh}_{method}.vtu"

    def restricted(self, methods=(), meshes=(), degrees=()):
        """The results of some methods, meshes and degrees only, in the order of the study; all of them where
        none is named. The initial mesh stays. Raises ResultsError for a name that is not there."""
        methods = find_all("method", methods, self.methods, self.titles)
        meshes = find_all("mesh", meshes, self.meshes, self.titles)
        chosen = find_all("degree", degrees, self.degrees) if degrees else ()

        def rows_of(rows):
            return rows.where(np.isin(rows.text("mesh"), meshes)
                              & np.isin(rows.text("method"), (INITIAL, *methods))
                              & (np.isin(rows.text("degree"), (*chosen, "")) if chosen else True))
        return replace(self, methods=methods, meshes=meshes, degrees=chosen or self.degrees, summary=rows_of(self.summary),
                       iterations=rows_of(self.iterations), thresholds=rows_of(self.thresholds),
                       repeated=tuple(mesh for mesh in self.repeated if mesh in meshes),
                       repetitions=tuple(other.restricted(methods, meshes, degrees) for other in self.repetitions))

    def result_record(self, rows):
        """Returns, of the rows of one mesh, method and degree, the record of the method's resulting mesh: the first one
        with its quality numbers. None if it was not recorded: not every iteration is. (The result need not be the last
        one, see `result_record` of the program.)"""
        names = [name for name in FINGERPRINT
                 if name in rows.columns and name in self.summary.columns]
        results = self.summary.select(mesh=rows.text("mesh")[0], method=rows.text("method")[0])
        if not len(results):
            return None
        same = np.all([rows.text(name) == results.text(name)[0] for name in names], axis=0)
        return int(np.argmax(same)) if same.any() else None

    def is_published(self, mesh):
        """True if the provenance calls the mesh one of the published ones."""
        return any(entry.get("name") == mesh and entry.get("published") is True
                   for entry in entries(self.provenance, "meshes"))


def read_results(folder):
    """Reads a results folder. summary.csv and iterations.csv must be there; thresholds.csv, solutions.csv, refined.csv
    and provenance.json may be absent. Raises ResultsError with one sentence on the fault."""
    folder = Path(folder)
    if not folder.is_dir():
        raise ResultsError(f"{folder}: there is no such folder.")
    summary, iterations = (read_checked(folder / name) for name in ("summary.csv", "iterations.csv"))
    for rows in (summary, iterations):
        if not len(rows):
            raise ResultsError(f"{rows.path}: the file has no rows.")
    thresholds, solutions, refined = (read_if_there(folder / name)
                                      for name in ("thresholds.csv", "solutions.csv", "refined.csv"))
    provenance = read_provenance(folder / "provenance.json")
    study = str(provenance.get("study") or summary.text("study")[0] or folder.resolve().name)
    titles = {INITIAL: "Initial"}
    for key in ("meshes", "methods"):
        titles.update({e["name"]: str(e["title"]) for e in entries(provenance, key) if e.get("title")})
    methods = order_of(summary.text("method"), provenance, "methods")
    declared = [entry["name"] for entry in entries(provenance, "methods")]
    return by_seed(Results(
        folder=folder, study=study, study_title=str(provenance.get("study_title") or study),
        meshes=order_of(summary.text("mesh"), provenance, "meshes"),
        methods=tuple(method for method in methods if method != INITIAL),
        study_methods=tuple(dict.fromkeys(name for name in (*declared, *methods) if name != INITIAL)),
        degrees=tuple(sorted({degree for degree in summary.text("degree") if degree}, key=float)),
        titles=titles, summary=summary, iterations=iterations, thresholds=thresholds,
        provenance=provenance, solutions=solutions, refined=refined))


def read_if_there(path):
    """The rows of a file; no rows if the file is absent."""
    if is_there(path):
        return read_checked(path)
    return Rows(path, {name: np.array([], dtype=object) for name in REQUIRED_COLUMNS[path.name]})


def read_checked(path):
    """The rows of one of the files; raises ResultsError if something in them has to be a number and is not."""
    rows = read_rows(path, REQUIRED_COLUMNS[path.name])
    rows.require_numbers(*REQUIRED_NUMBERS[path.name])
    for name in number_columns(rows):
        rows.number(name)
    return rows


def number_columns(rows):
    """The columns that hold numbers."""
    return [name for name in rows.columns if name in NUMBERS or of_solver(name)[0]]


def left_out(results):
    """A sentence for each column that holds something that is not a finite number: there, tables have a dash and lines
    a gap."""
    counted = [(rows, name, rows.without_number(name))
               for rows in (results.iterations, results.summary) for name in number_columns(rows)]
    return [f"{rows.path}: `{name}` is no finite number in {count} of {len(rows)} rows; there, lines have "
            "a gap and tables a dash." for rows, name, count in counted if count]
