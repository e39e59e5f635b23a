# SPDX-License-Identifier: GPL-3.0-or-later
"""What is made of the results of each kind of study: the key `kind` of its study file."""

from dataclasses import dataclass
from pathlib import Path
from typing import Callable

from .claims.check import check_claims, read_claims
from .claims.report import claims_as_markdown
from .results.polygons import read_polygon_results
from .results.printed_values import read_printed_tables
from .results.regularization import read_regularization_results
from .results.rows import ResultsError, read_provenance
from .results.smoothing import read_results
from .tables.polygons import make_polygon_tables
from .tables.regularization import make_regularization_tables
from .tables.smoothing import make_tables


@dataclass(frozen=True)
class Outputs:
    """Tables, texts (file name -> content) to stand beside them, and what draws the figures: takes a
    function for sentences on what is left out, returns the paths."""

    folder: Path
    tables: tuple
    texts: dict
    draw: Callable


def smoothing_outputs(folder):
    """Of a study of smoothing methods."""
    results = read_results(folder)
    printed = read_printed_tables(results.study, results.provenance)
    claims, texts = read_claims(results.study), {}
    if claims:
        texts["claims.md"] = claims_as_markdown(check_claims(claims, results, printed), results)

    def draw(report):
        from .figures.smoothing_study import draw_figures  # matplotlib takes a second to load
        return draw_figures(results, report)
    return Outputs(results.folder, tuple(make_tables(results, printed)), texts, draw)


def polygon_outputs(folder):
    """Of a study of polygon transformations."""
    results = read_polygon_results(folder)

    def draw(report):
        from .figures.polygon_study import draw_polygon_figures
        return draw_polygon_figures(results)
    return Outputs(results.folder, tuple(make_polygon_tables(results)), {}, draw)


def regularization_outputs(folder):
    """Of a study of the regularization of volume elements."""
    results = read_regularization_results(folder)

    def draw(report):
        from .figures.regularization import draw_regularization_figures
        return draw_regularization_figures(results)
    return Outputs(results.folder, tuple(make_regularization_tables(results)), {}, draw)


KINDS = {"smoothing": smoothing_outputs, "polygons": polygon_outputs,
         "regularization": regularization_outputs}


def outputs_of(folder):
    """Reads a results folder of any kind; raises ResultsError with one sentence on what is wrong."""
    provenance = read_provenance(Path(folder) / "provenance.json")
    parameters = provenance.get("parameters")
    kind = parameters.get("kind", "smoothing") if isinstance(parameters, dict) else "smoothing"
    if kind not in KINDS:
        raise ResultsError(f"{folder}: a study of the unknown kind `{kind}`; known are "
                           f"{', '.join(KINDS)}.")
    return KINDS[kind](folder)
