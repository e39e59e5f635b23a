# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of a collection: what predicts the error, and how methods compare over all problems."""

import matplotlib.pyplot as pyplot
import numpy as np

from ..collections.diagrams import DIAGRAMS, diagrams
from ..collections.prediction import predictions, samples_of
from ..results.method_styles import method_styles
from ..results.symbols import symbol_of
from . import style
from .planned import PlannedFigure

MOST_POINTS = 3000  # of a scatter plot


def plan_collection_figures(results):
    """All of them; none where no member is complete."""
    if not len(results.iterations):
        return []
    return [PlannedFigure("prediction", "rank correlation of quality and outcome", lambda: draw_prediction(results)),
            PlannedFigure("prediction_extremes", "the best and the worst predictor of the H1 error",
                          lambda: draw_extremes(results)),
            *(PlannedFigure(name, title, lambda name=name: draw_diagram(results, diagrams(results).get(name)))
              for name, title in DIAGRAMS.items())]


def draw_prediction(results):
    """A heat map: qualities by outcomes, a panel for each type of elements and degree."""
    found = predictions(results)
    kinds = list(dict.fromkeys((p.elements, p.degree) for p in found))
    if not kinds:
        return None
    qualities = list(dict.fromkeys(p.quality for p in found))
    outcomes = list(dict.fromkeys(p.outcome for p in found))
    columns = min(len(kinds), style.columns_that_fit(3))
    n_rows = -(-len(kinds) // columns)
    height, fontsize = (0.25, 7) if len(qualities) < 8 else (0.15, 5.5)
    figure, axes = pyplot.subplots(n_rows, columns, squeeze=False, constrained_layout=True, sharex=True, sharey=True,
                                   figsize=(style.full_width(), 1.3 + n_rows * (0.7 + height * len(qualities))))
    for ax, kind in zip(axes.flat, kinds):
        rho = np.full((len(qualities), len(outcomes)), np.nan)
        for p in found:
            if (p.elements, p.degree) == kind:
                rho[qualities.index(p.quality), outcomes.index(p.outcome)] = p.mean
        image = ax.imshow(rho, vmin=-1, vmax=1, cmap="RdBu", aspect="auto")
        for (i, j), value in np.ndenumerate(rho):
            if np.isfinite(value):
                ax.text(j, i, f"{value:.2f}", ha="center", va="center", fontsize=fontsize,
                        color="white" if abs(value) > 0.6 else "black")
        ax.set_title(f"{kind[0].capitalize()}, $d$ = {kind[1]}")
        ax.set_xticks(range(len(outcomes)), [symbol_of(name).tex for name in outcomes], rotation=90)
        ax.set_yticks(range(len(qualities)), [symbol_of(name).tex for name in qualities], fontsize=fontsize + 1)
        ax.grid(False)
    for ax in list(axes.flat)[len(kinds):]:
        ax.set_axis_off()
    figure.colorbar(image, ax=axes, label="Spearman's rank correlation", shrink=0.8)
    return figure


def draw_extremes(results):
    """Scatter plots of the strongest and the weakest correlation with the H1 error."""
    found = sorted((p for p in predictions(results) if p.outcome == "h1_error" and np.isfinite(p.mean)),
                   key=lambda p: p.mean)
    if not found:
        return None
    shown = [found[0]] if len(found) == 1 else [found[0], max(found, key=lambda p: -abs(p.mean))]
    figure, axes = pyplot.subplots(1, len(shown), squeeze=False, constrained_layout=True,
                                   figsize=(style.full_width(), 2.8))
    for ax, p in zip(axes.flat, shown):
        sample = next(s for s in samples_of(results) if (s.elements, s.degree) == (p.elements, p.degree))
        q, error = sample.qualities[p.quality], sample.relative["h1_error"]
        some = np.linspace(0, len(q) - 1, min(len(q), MOST_POINTS)).astype(int)
        ax.plot(q[some], error[some], ".", markersize=2, alpha=0.5, color=style.ELEMENT_COLOURS["triangle"],
                rasterized=True)
        ax.set_yscale("log")
        ax.set_xlabel(symbol_of(p.quality).tex)
        ax.set_ylabel("H1 error / least of the member")
        ax.set_title(f"{p.elements.capitalize()}, $d$ = {p.degree}: {p.mean:.2f}")
    return figure


def draw_diagram(results, diagram):
    """Draws a line for each method; returns None without a diagram."""
    if diagram is None:
        return None
    styles = method_styles(results.methods)
    figure, ax = pyplot.subplots(figsize=(style.width_of(1.4 * style.SINGLE_WIDTH), 3.0), constrained_layout=True)
    for curve in diagram.curves:
        look, label = styles[curve.method], results.title(curve.method)
        common = {"color": look.colour, "dashes": look.dashes or (1, 0), "label": label}
        if diagram.is_share:
            ax.step(curve.x, curve.y, where="post", marker=look.marker, markevery=max(1, len(curve.x) // 6), markersize=3,
                    markerfacecolor=look.marker_fill, **common)
        else:
            ax.fill_between(curve.x, curve.lower, curve.upper, color=look.colour, alpha=0.12, linewidth=0)
            ax.plot(curve.x, curve.y, **common)
    ax.set_xscale("log")
    if diagram.is_share:
        ax.set_ylim(0, 1.02)
    else:
        ax.set_yscale("log")
    ax.set_xlabel(diagram.x_label)
    ax.set_ylabel(diagram.y_label)
    ax.legend(fontsize=7)
    return figure
