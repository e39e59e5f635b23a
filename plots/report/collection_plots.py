# SPDX-License-Identifier: GPL-3.0-or-later
"""The plots in the report of a collection: what predicts the error, and curves of methods, as data for the page's script."""

import numpy as np

from ..collections.diagrams import DIAGRAMS, diagrams
from ..collections.prediction import predictions, samples_of
from ..results.symbols import symbol_of
from .looks import looks_of

MOST_POINTS = 500  # of a scatter plot: they are in the page for every quality
MOST_STEPS = 300  # of a curve


def collection_plots(results):
    """All of it, ready for JSON; empty where no member is complete."""
    if not len(results.iterations):
        return {}
    found = predictions(results)
    qualities, outcomes = (list(dict.fromkeys(getattr(p, name) for p in found)) for name in ("quality", "outcome"))
    return {"titles": {name: results.title(name) for name in results.methods},
            "looks": looks_of(results.methods),
            "diagrams": [{"name": name, "title": DIAGRAMS[name].capitalize(), **diagram_data(diagram)}
                         for name, diagram in diagrams(results).items()],
            "qualities": qualities, "outcomes": outcomes,
            "headings": {name: symbol_of(name).text for name in (*qualities, *outcomes)},
            "kinds": [kind_data(sample, found, qualities, outcomes) for sample in samples_of(results)]}


def diagram_data(diagram):
    """Axes and curves; of many steps some, the last of them always."""
    def curve_data(curve):
        some = np.unique(np.linspace(0, len(curve.x) - 1, min(len(curve.x), MOST_STEPS)).round().astype(int))
        return {"method": curve.method, **{name: rounded(values[some]) for name in ("x", "y", "lower", "upper")
                                           if (values := getattr(curve, name)) is not None}}
    return {"x": diagram.x_label, "y": diagram.y_label, "is_share": diagram.is_share,
            "curves": [curve_data(curve) for curve in diagram.curves]}


def kind_data(sample, found, qualities, outcomes):
    """A type of elements at a degree: correlations (a row for each quality), and some of the records."""
    rho = {(p.quality, p.outcome): p.mean for p in found
           if (p.elements, p.degree) == (sample.elements, sample.degree)}
    some = np.linspace(0, len(sample.members) - 1, min(len(sample.members), MOST_POINTS)).astype(int)
    return {"name": f"{sample.elements.capitalize()}, d = {sample.degree}",
            "rho": [rounded([rho.get((quality, outcome), np.nan) for outcome in outcomes]) for quality in qualities],
            "members": list(sample.members[some]),
            "qualities": {name: rounded(sample.qualities[name][some]) for name in qualities},
            "relative": {name: rounded(sample.relative[name][some]) for name in outcomes}}


def rounded(values):
    """Rounds to four digits, more than can be seen; None for unknown numbers, as JSON has no NaN."""
    return [float(f"{value:.4g}") if np.isfinite(value) else None for value in values]
