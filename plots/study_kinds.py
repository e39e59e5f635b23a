# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables, texts and figures that are made of the results of each kind of study: the key `kind` of its study file."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable

from .claims.check import check_claims, read_claims
from .claims.report import claims_as_markdown, totals
from .report.reload import make_final, make_reloading
from .results.collection import read_collection_results
from .results.polygons import read_polygon_results
from .results.printed_values import read_printed_tables
from .results.regularization import read_regularization_results
from .results.request import Request
from .results.rows import ResultsError, read_provenance
from .results.smoothing import left_out, read_results
from .tables.chosen import chosen_table
from .tables.collection import make_collection_tables
from .tables.energy import make_energy_tables
from .tables.polygons import make_polygon_tables
from .tables.formats import as_text
from .tables.regularization import make_regularization_tables
from .tables.screen import screen
from .tables.seeds import make_seed_tables
from .tables.smoothing import make_tables
from .tables.solvers import make_solver_tables

LEAST_WIDTH = 6.0  # of figures whose panels cannot go below each other
NO_CLAIMS = "No claims.md: the thesis says nothing about this study."


@dataclass(frozen=True)
class Outputs:
    """Tables, texts (file name without suffix -> content) next to them, and functions that plan the figures: `plan`
    plans figures that need no meshes, `plan_of_meshes` the others. The latter takes a function for sentences on figures
    that are left out."""

    folder: Path
    study_title: str
    tables: tuple
    plan: Callable
    screen: str  # what a study shows when it ends
    plan_of_meshes: Callable = lambda report: []
    texts: dict = field(default_factory=dict)
    remarks: tuple = ()  # sentences on what a user may look for in vain
    warnings: tuple = ()  # sentences on problems of the results
    least_width: float = 0.0  # inches that the words in the figures need
    write_report: Callable = None  # (against, path) -> the path of the page written; None: that of tables and figures
    plots: Callable = lambda: None  # of that page in place of figures, as data
    provenance: dict = field(default_factory=dict)
    page_shows_figures: bool = False  # whether the page is made of the files of figures

    def write_page(self, against=None, path=None, reload=False):
        """Writes report.html, or to a path; returns where. reload: a page that is open in a browser shows the next version by
        itself. Raises ResultsError or NoLibrary."""
        written = self.write_page_once(against, path)
        (make_reloading if reload else make_final)(written)
        return written

    def write_page_once(self, against, path):
        """Writes report.html, or to a path; returns where."""
        if self.write_report:
            return self.write_report(against, path)
        if against is not None:
            raise ResultsError(f"{self.folder}: only studies that smooth meshes can be compared; leave out --against.")
        from .report.tables_page import write_tables_report
        return write_tables_report(self.folder, self.study_title, self.tables, self.plan(), tuple(self.texts.values()),
                                   self.plots(), path)

    @property
    def names(self):
        """Names of tables and texts."""
        return [table.name for table in self.tables] + list(self.texts)


def smoothing_outputs(folder, request):
    """Outputs of a study of smoothing methods."""
    whole = read_results(folder)
    results = whole.restricted(request.methods, request.meshes, request.degrees)
    # Whether a method pays is judged by the next degree, too.
    of_all_degrees = whole.restricted(request.methods, request.meshes)
    printed = read_printed_tables(results.thesis_study, results.provenance)
    claims, outcomes, texts = read_claims(results.thesis_study), (), {}
    if claims and all(getattr(results, name) == getattr(whole, name) for name in ("methods", "meshes", "degrees")):
        outcomes = check_claims(claims, results, printed)
        texts["claims"] = claims_as_markdown(outcomes, results)

    def plan():
        from .figures.history_study import plan_histories, plan_requested_history
        from .figures.norms import plan_norms
        if request.has_history:
            return plan_requested_history(results, request)
        return plan_histories(results) + (plan_norms(results) if results.thesis_study else [])

    def plan_of_meshes(report):
        from .figures.smoothing_study import plan_mesh_figures
        return plan_mesh_figures(results, report)

    def write_page(against, path):
        from .report.page import write_report
        return write_report(results, outcomes, against, path, tables)
    tables = (*([chosen_table(results, request.columns)] if request.columns else []), *make_tables(results, printed),
              *make_solver_tables(results), *make_seed_tables(results), *make_energy_tables(of_all_degrees))
    shown = screen(results) + (claims_sentence(outcomes, results) if outcomes and not results.is_quick else "")
    return Outputs(results.folder, results.study_title, tables, plan, shown, plan_of_meshes, texts,
                   () if claims else (NO_CLAIMS,), tuple(left_out(results)), write_report=write_page,
                   provenance=results.provenance)


def claims_sentence(outcomes, results):
    """The number of claims that hold, and a warning if the meshes are not those of the thesis."""
    generated = "" if any(map(results.is_published, results.meshes)) else (
        " The thesis speaks of other meshes than these, which this program has generated.")
    return f"{totals(outcomes)} (tables/claims.md).{generated}\n"


def polygon_outputs(folder, request):
    """Outputs of a study of polygon transformations."""
    results = read_polygon_results(folder)

    def plan():
        from .figures.polygon_study import plan_polygon_figures
        return plan_polygon_figures(results)
    tables = tuple(make_polygon_tables(results))
    return Outputs(results.folder, results.study_title, tables, plan, as_text(tables[0]), least_width=LEAST_WIDTH,
                   page_shows_figures=True, provenance=read_provenance(results.folder / "provenance.json"))


def regularization_outputs(folder, request):
    """Outputs of a study of the regularization of volume elements."""
    results = read_regularization_results(folder)

    def plan():
        from .figures.regularization import plan_regularization_figures
        return plan_regularization_figures(results)
    tables = tuple(make_regularization_tables(results))
    return Outputs(results.folder, results.study_title, tables, plan, as_text(tables[0]), least_width=LEAST_WIDTH,
                   page_shows_figures=True, provenance=read_provenance(results.folder / "provenance.json"))


def collection_outputs(folder, request):
    """Outputs of a collection."""
    results = read_collection_results(folder)
    tables, findings = make_collection_tables(results)

    def plan():
        from .figures.collection import plan_collection_figures
        return plan_collection_figures(results)

    def plots():
        from .report.collection_plots import collection_plots
        return collection_plots(results)
    return Outputs(results.folder, results.study_title, tuple(tables), plan, findings, texts={"findings": findings},
                   least_width=LEAST_WIDTH, plots=plots, provenance=read_provenance(results.folder / "provenance.json"))


SMOOTHING = "smoothing"  # the kind of a study that names none
KINDS = {SMOOTHING: smoothing_outputs, "polygons": polygon_outputs, "collection": collection_outputs,
         "regularization": regularization_outputs}


def kind_of(folder):
    """The kind of the study whose results a folder has."""
    parameters = read_provenance(Path(folder) / "provenance.json").get("parameters")
    return parameters.get("kind", SMOOTHING) if isinstance(parameters, dict) else SMOOTHING


def outputs_of(folder, request=Request()):
    """Reads a results folder of any kind; raises ResultsError with one sentence on the fault."""
    kind = kind_of(folder)
    if kind not in KINDS:
        raise ResultsError(f"{folder}: a study of the unknown kind `{kind}`; known are "
                           f"{', '.join(KINDS)}.")
    if kind != SMOOTHING and request != Request():
        raise ResultsError(f"{folder}: a study of the kind `{kind}` has no methods, meshes, degrees, columns or "
                           "histories to choose from; leave out --methods, --meshes, --degrees, --columns, --x, --y and the options "
                           "of their axes.")
    return KINDS[kind](folder, request)
