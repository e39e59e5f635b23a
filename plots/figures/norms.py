# SPDX-License-Identifier: GPL-3.0-or-later
"""Three errors of one finite element solution: the norm of the thesis, the true error, and the least one that the mesh allows."""

import matplotlib.pyplot as pyplot

from ..results.smoothing import INITIAL
from . import style
from .planned import PlannedFigure

# Column -> (label, mark). e_H1 compares u_h with the nodal interpolant of u, which is itself far from u on flat cells. So it
# falls much more than the true error when bad cells become good.
ERRORS = {"e_h1": (r"$\Vert I_h u-u_h\Vert_{H^1}$: norm of the thesis", "o"),
          "h1_error": (r"$\Vert u-u_h\Vert_{H^1}$: true error", "s"),
          "h1_best": (r"$\min_v\,\Vert u-v\Vert_{H^1}$: best approximation", "|")}
ROW_HEIGHT, LEGEND_ROW = 0.2, 0.18  # inches


def plan_norms(results):
    """The figure, for results that have all three errors."""
    columns = results.summary.columns
    if not all(name in columns and any(columns[name]) for name in ERRORS):
        return []
    return [PlannedFigure("norms", "three errors of one solution", lambda: draw_norms(results))]


def draw_norms(results):
    """A panel for each mesh and degree, a row for each method."""
    panels = [(mesh, degree) for mesh in results.meshes for degree in results.degrees]
    methods = (INITIAL, *results.methods)
    columns = min(len(panels), 2)
    n_rows = -(-len(panels) // columns)
    figure, axes = pyplot.subplots(n_rows, columns, squeeze=False, constrained_layout=True, sharey=True,
                                   figsize=(style.full_width(), 0.6 + n_rows * (0.6 + ROW_HEIGHT * len(methods))))
    for ax, (mesh, degree) in zip(axes.flat, panels):
        for (column, (label, mark)), colour in zip(ERRORS.items(), ("tab:red", "tab:blue", "black")):
            rows = [results.summary.select(mesh=mesh, degree=degree, method=method) for method in methods]
            known = [(row.number(column)[0], place) for place, row in enumerate(rows) if len(row)]
            ax.plot(*zip(*known), mark, color=colour, markersize=8 if mark == "|" else 4, label=label,
                    markeredgewidth=1.5 if mark == "|" else 0.5)
        ax.set_xscale("log")
        ax.margins(y=0.1)
        ax.set_title(f"{results.title(mesh)}, $d$ = {degree}")
        ax.set_yticks(range(len(methods)), [results.title(method) for method in methods])
    axes[0, 0].invert_yaxis()
    for ax in list(axes.flat)[len(panels):]:
        ax.set_axis_off()
    # The layout leaves room for the legend below the panels.
    legend_columns = 1 if style.full_width() < 5 else len(ERRORS)
    height = LEGEND_ROW * (len(ERRORS) // legend_columns + 0.5) / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, height, 1, 1 - height))
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="lower center", ncol=legend_columns, fontsize=7)
    return figure
