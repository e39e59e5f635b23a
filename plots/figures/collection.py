# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of a collection: what predicts the error, and how methods compare over all problems."""

from functools import cached_property

import matplotlib.pyplot as pyplot
import numpy as np

from ..collections.comparison import solving_costs
from ..collections.prediction import predictions, samples_of
from ..collections.problems import problems_of
from ..results.symbols import symbol_of
from ..statistics.profiles import anytime, performance_profile, runtime_distribution
from . import style
from .planned import PlannedFigure

N_TIMES = 100  # of anytime curves
MOST_POINTS = 3000  # of a scatter plot


class Data:
    """What several figures are made of, computed when the first of them needs it."""

    def __init__(self, results):
        self.results = results

    @cached_property
    def problems(self):
        return problems_of(self.results)

    @cached_property
    def samples(self):
        return samples_of(self.results)

    @cached_property
    def predictions(self):
        return predictions(self.results)


def plan_collection_figures(results):
    """All of them; none where no member is complete."""
    if not len(results.iterations):
        return []
    data = Data(results)
    return [PlannedFigure(name, title, lambda draw=draw: draw(data)) for name, title, draw in (
        ("prediction", "rank correlation of quality and outcome", draw_prediction),
        ("prediction_extremes", "the best and the worst predictor of the H1 error", draw_extremes),
        ("profile", "performance profiles", draw_profile),
        ("runtime", "runtime to targets", draw_runtime),
        ("anytime", "error against time", draw_anytime))]


def draw_prediction(data):
    """A heat map: qualities by outcomes, a panel for each type of elements and degree."""
    found = data.predictions
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
                rho[qualities.index(p.quality), outcomes.index(p.outcome)] = p.across
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


def draw_extremes(data):
    """Scatter plots of the strongest and the weakest correlation with the H1 error."""
    found = sorted((p for p in data.predictions if p.outcome == "h1_error" and np.isfinite(p.across)),
                   key=lambda p: p.across)
    if not found:
        return None
    shown = [found[0]] if len(found) == 1 else [found[0], max(found, key=lambda p: -abs(p.across))]
    figure, axes = pyplot.subplots(1, len(shown), squeeze=False, constrained_layout=True,
                                   figsize=(style.full_width(), 2.8))
    for ax, p in zip(axes.flat, shown):
        sample = next(s for s in data.samples if (s.elements, s.degree) == (p.elements, p.degree))
        q, error = sample.qualities[p.quality], sample.relative["h1_error"]
        some = np.linspace(0, len(q) - 1, min(len(q), MOST_POINTS)).astype(int)
        ax.plot(q[some], error[some], ".", markersize=2, alpha=0.5, color=style.ELEMENT_COLOURS["triangle"],
                rasterized=True)
        ax.set_yscale("log")
        ax.set_xlabel(symbol_of(p.quality).tex)
        ax.set_ylabel("H1 error / least of the member")
        ax.set_title(f"{p.elements.capitalize()}, $d$ = {p.degree}: {p.across:.2f}")
    return figure


def draw_steps(data, curves, x_label, y_label):
    """A step line for each method: (x ascending, share)."""
    styles = style.method_styles(data.results.methods)
    figure, ax = pyplot.subplots(figsize=(style.width_of(1.4 * style.SINGLE_WIDTH), 3.0), constrained_layout=True)
    for method, (x, share) in curves.items():
        look = styles[method]
        if len(x):
            ax.step(x, share, where="post", color=look.colour, dashes=look.dashes or (1, 0), marker=look.marker,
                    markevery=max(1, len(x) // 6), markersize=3, markerfacecolor=look.marker_fill,
                    label=data.results.title(method))
    if not ax.get_lines():
        pyplot.close(figure)
        return None
    ax.set_xscale("log")
    ax.set_ylim(0, 1.02)
    ax.set_xlabel(x_label)
    ax.set_ylabel(y_label)
    ax.legend(fontsize=7)
    return figure


def draw_profile(data):
    """Dolan and More's profiles of the time to an error within 5 % of the least."""
    return draw_steps(data, performance_profile(solving_costs(data.problems, data.results.methods)),
                      "Smoothing time / least of any method", "Share of problems solved")


def draw_runtime(data):
    """COCO's distributions of runtimes to targets."""
    times = runtime_distribution([problem.errors() for problem in data.problems])
    curves = {}
    for method, values in times.items():
        reached = np.sort(values[np.isfinite(values)])
        curves[method] = np.maximum(reached, 1e-6), np.arange(1, len(reached) + 1) / max(1, len(values))
    return draw_steps(data, curves, "Smoothing time (s)", "Share of problems and targets")


def draw_anytime(data):
    """Median and quartiles of the error so far over the initial one."""
    problems = [problem.errors() for problem in data.problems]
    ends = [times[-1] for curves in problems for times, _ in curves.values() if times[-1] > 0]
    if not ends:
        return None
    grid = np.geomspace(max(min(ends) / 10, 1e-6), max(ends), N_TIMES)
    styles = style.method_styles(data.results.methods)
    figure, ax = pyplot.subplots(figsize=(style.width_of(1.4 * style.SINGLE_WIDTH), 3.0), constrained_layout=True)
    for method in data.results.methods:
        lower, median, upper = anytime(problems, method, grid)
        look = styles[method]
        ax.fill_between(grid, lower, upper, color=look.colour, alpha=0.12, linewidth=0)
        ax.plot(grid, median, color=look.colour, dashes=look.dashes or (1, 0), label=data.results.title(method))
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlabel("Smoothing time (s)")
    ax.set_ylabel("H1 error / initial")
    ax.legend(fontsize=7)
    return figure
