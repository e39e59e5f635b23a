# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons drawn side by side: Figures 2.3, 2.5, 2.10 and 2.12 of the thesis."""

import math

import matplotlib.pyplot as pyplot
import numpy as np

from ..results.polygons import nodes_of
from ..results.rows import groups_of
from . import style

# The first three nodes tell the orientation, as in the thesis; the others are all alike.
NODE_COLOURS = ("#D55E00", "#009E73", "#0072B2")
OTHER_NODES, SIDES = "0.25", "0.45"
SPACE = 1.3  # side of a square panel / largest size of the polygons in it


def draw_polygon(ax, nodes, node_size=9.0):
    """Sides as lines, nodes as dots; nodes that coincide are drawn once, the first on top."""
    closed = np.vstack([nodes, nodes[:1]])
    ax.plot(closed[:, 0], closed[:, 1], color=SIDES, linewidth=0.7, solid_joinstyle="round")
    colours = [NODE_COLOURS[i] if i < len(NODE_COLOURS) else OTHER_NODES for i in range(len(nodes))]
    ax.scatter(nodes[::-1, 0], nodes[::-1, 1], s=node_size, c=colours[::-1], linewidths=0, zorder=3)


def extent_of(polygons):
    """The largest width or height of polygons."""
    return max(float(np.ptp(nodes, axis=0).max()) for nodes in polygons)


def square_panel(ax, nodes, extent):
    """An empty square with a polygon in the middle."""
    middle = 0.5 * (nodes.min(axis=0) + nodes.max(axis=0))
    half = 0.5 * SPACE * extent
    ax.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half),
           xticks=(), yticks=(), aspect="equal")
    ax.axis("off")
    draw_polygon(ax, nodes)


def angle_text(theta):
    """An angle as a multiple of pi with a small denominator, else in decimals."""
    for denominator in range(1, 65):
        numerator = round(theta / math.pi * denominator)
        if numerator and abs(theta - math.pi * numerator / denominator) < 1e-9:
            top = r"\pi" if numerator == 1 else rf"{numerator}\pi"
            return top if denominator == 1 else f"{top}/{denominator}"
    return f"{theta:.3f}"


def domain_text(domain):
    """D_3 as mathematics."""
    return f"{domain[0]}_{{{domain[2:]}}}"


def draw_decomposition(results):
    """Figure 2.10: polygon = v_0 + v_1 + ..., a row for each number of nodes."""
    rows = groups_of(results.decomposition, "n")
    columns = 1 + max(len(groups_of(parts, "eigenpolygon")) - 1 for _, parts in rows)
    gap, title = 0.28, 0.22  # of the panels' sides, and in inches
    side = style.full_width() / (columns + gap * (columns - 1))
    height = (side + title) * len(rows)
    figure, axes = pyplot.subplots(len(rows), columns, squeeze=False,
                                   figsize=(style.full_width(), height))
    figure.subplots_adjust(left=0, right=1, bottom=0, top=1 - title / height, wspace=gap,
                           hspace=title / side)
    for row, (_, parts) in zip(axes, rows):
        shown = [(key, nodes_of(part)) for (key,), part in groups_of(parts, "eigenpolygon")]
        extent = extent_of([nodes for _, nodes in shown])
        for ax in row[len(shown):]:
            ax.axis("off")
        for number, (ax, (key, nodes)) in enumerate(zip(row, shown)):
            square_panel(ax, nodes, extent)
            ax.set_title(rf"$v_{{{key}}}$" if key else "$z$", pad=1)
            if number:
                ax.text(-0.5 * gap, 0.5, "=" if number == 1 else "+", transform=ax.transAxes,
                        ha="center", va="center", fontsize=12)
    return figure


def draw_sequences(results, transformation, same_scale):
    """Figures 2.5 and 2.12: a row for each pair of parameters, a column for each step.

    same_scale: all polygons to one scale; otherwise each fills its panel.
    """
    rows = groups_of(results.sequences.select(transformation=transformation),
                     "theta", "lambda", "domain")
    if not rows:
        return None
    table = [[(step, nodes_of(polygon)) for (step,), polygon in groups_of(part, "step")]
             for _, part in rows]
    largest = extent_of([nodes for row in table for _, nodes in row])
    columns, label = len(table[0]), 1.15
    side = min((style.full_width() - label) / columns, 0.95)
    width, height = label + side * columns, side * len(rows) + 0.25
    figure, axes = pyplot.subplots(len(rows), columns, squeeze=False, figsize=(width, height))
    figure.subplots_adjust(left=label / width, right=1, bottom=0, top=1 - 0.25 / height, wspace=0,
                           hspace=0)
    for line, ((theta, lam, domain), _), row in zip(axes, rows, table):
        for ax, (step, nodes) in zip(line, row):
            square_panel(ax, nodes, largest if same_scale else max(extent_of([nodes]), 1e-12))
        text = rf"$\theta={angle_text(float(theta))}$" + "\n"
        if transformation == "combined":
            text += rf"$\lambda={float(lam):.3g}$" + "\n"
        line[0].text(-0.08, 0.5, text + f"${domain_text(domain)}$", transform=line[0].transAxes,
                     ha="right", va="center", fontsize=8, linespacing=1.25)
    for ax, (step, _) in zip(axes[0], table[0]):
        ax.set_title(rf"$\ell={step}$", pad=4)
    return figure


def draw_limits(results):
    """Figure 2.3: the limits along the axis of base angles, a panel for each number of nodes. Limits
    inside the intervals stand above those at the characteristic angles between them."""
    rows = groups_of(results.limits, "n")
    width, lane = style.full_width(), 1.02
    left, right, foot = 1.05, 0.45, 0.42
    height = (2 * lane + foot + 0.05) * len(rows)
    figure = pyplot.figure(figsize=(width, height))
    scale = (width - left - right) / (0.5 * math.pi)  # inches of one radian
    for number, ((n,), part) in enumerate(rows):
        ax = figure.add_axes((0, 1 - (number + 1) / len(rows) + foot / height, 1, 2 * lane / height))
        ax.set(xlim=(-left, width - left), ylim=(0, 2 * lane))
        count = int(n)
        for k in range(count // 2):
            ax.axvline(scale * (2 * k + 1) * math.pi / (2 * count), color="0.8", linewidth=0.6,
                       linestyle=(0, (3, 2)), zorder=0)
        size = min(0.64 * lane, 0.8 * scale * math.pi / count)
        for (theta, domain), polygon in groups_of(part, "theta", "domain"):
            at = scale * float(theta) if domain else -0.55 * left
            height_of_lane = 0.5 * lane if domain.startswith("S") else 1.5 * lane
            nodes = nodes_of(polygon)
            middle = 0.5 * (nodes.min(axis=0) + nodes.max(axis=0))
            extent = extent_of([nodes])
            # A point has no size to be brought to that of the others.
            factor = size / extent if extent > 1e-6 else 0.0
            draw_polygon(ax, (nodes - middle) * factor + (at, height_of_lane + 0.05 * lane), 7.0)
            ax.text(at, height_of_lane - 0.38 * lane, f"${domain_text(domain)}$" if domain else "$z$",
                    ha="center", va="center", fontsize=7, color="0.3",
                    bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5})
        draw_angle_axis(ax, count, scale)
    return figure


def draw_angle_axis(ax, count, scale):
    """Ticks at 0, the characteristic angles and pi/2."""
    ax.grid(False)
    for spine in ax.spines.values():
        spine.set_visible(False)
    ax.plot([0, scale * 0.5 * math.pi], [0, 0], color="black", linewidth=1.0, clip_on=False)
    angles = [0.0] + [(2 * k + 1) * math.pi / (2 * count) for k in range(count // 2)] + [math.pi / 2]
    if angles[-1] - angles[-2] < 1e-9:  # odd numbers of nodes: the last characteristic angle is below
        angles.pop()
    ax.set_xticks([scale * angle for angle in angles])
    labels = ["0"] + [rf"${2 * k + 1 if k else ''}\pi/{2 * count}$" for k in range(count // 2)]
    ax.set_xticklabels(labels + [r"$\pi/2$"])
    ax.set_yticks(())
    ax.set_xlabel(rf"base angle $\theta$, $n={count}$", labelpad=1)
