# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 2.11 of the thesis: which eigenvalue dominates where, and how fast limits are reached."""

import matplotlib.pyplot as pyplot
import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.ticker import FixedLocator

from ..results.rows import groups_of
from . import style
from .polygons import domain_text

# Light ones, so that lines and names on them can be read; used again for more than these.
DOMAIN_COLOURS = ("#f2c5b3", "#bcd7ea", "#bfe3d3", "#f7e3b5", "#e6cbdc", "#d9d9d9", "#cfe9f5")


def grid_of(rows, values):
    """(theta, lambda, values) of a full grid; values as shape (lambdas, thetas)."""
    theta, at_theta = np.unique(rows.number("theta"), return_inverse=True)
    lam, at_lam = np.unique(rows.number("lambda"), return_inverse=True)
    grid = np.full((len(lam), len(theta)), np.nan)
    grid[at_lam, at_theta] = values
    return theta, lam, grid


def draw_domains(results):
    """A row for each number of nodes: domains with all intersection lines (those of the dominant
    eigenvalues solid), and the factor of convergence."""
    parts = groups_of(results.domains, "n")
    panel = 2.35
    height = panel * len(parts) + 0.42
    figure, axes = pyplot.subplots(len(parts), 2, squeeze=False, sharex=True, sharey=True,
                                   figsize=(style.full_width(), height))
    figure.subplots_adjust(left=0.08, right=0.9, bottom=0.4 / height, top=1 - 0.22 / height,
                           wspace=0.08, hspace=0.12)
    # Tenths, and the same for all panels.
    slowest = np.floor(10 * results.domains.number("convergence").min()) / 10
    for (left, right), ((n,), part) in zip(axes, parts):
        inside = part.select(line="")
        colour_domains(left, inside)
        mesh = right.pcolormesh(*grid_of(inside, inside.number("convergence")),
                                cmap=style.SOLUTION_MAP, vmin=slowest, vmax=1, shading="nearest",
                                rasterized=True)
        draw_lines(left, part, "black")
        draw_lines(right, part, "white")
        left.set_ylabel(rf"$\lambda$  ($n={n}$)")
    for ax in axes.flat:
        ax.grid(False)
        ax.set(xlim=(0, np.pi / 2), ylim=(0, 1))
        ax.xaxis.set_major_locator(FixedLocator([0, np.pi / 8, np.pi / 4, 3 * np.pi / 8, np.pi / 2]))
        ax.set_xticklabels(["0", r"$\pi/8$", r"$\pi/4$", r"$3\pi/8$", r"$\pi/2$"])
    for ax in axes[-1]:
        ax.set_xlabel(r"$\theta$")
    axes[0][0].set_title("Dominant eigenvalue")
    axes[0][1].set_title("Next eigenvalue / dominant one")
    figure.colorbar(mesh, cax=figure.add_axes((0.92, 0.4 / height, 0.02, 1 - 0.62 / height)))
    return figure


def colour_domains(ax, rows):
    """The domains of a full grid with their names."""
    domains = np.array([int(name[2:]) for name in rows.text("domain")])
    theta, lam, index = grid_of(rows, domains)
    colours = ListedColormap([DOMAIN_COLOURS[k % len(DOMAIN_COLOURS)]
                              for k in range(domains.max() + 1)])
    ax.pcolormesh(theta, lam, index, cmap=colours, vmin=-0.5, vmax=domains.max() + 0.5,
                  shading="nearest", rasterized=True)
    for k in range(domains.max() + 1):
        name_domain(ax, theta, lam, index == k, domain_text(f"D_{k}"), colours(k))


def draw_lines(ax, rows, colour):
    """The lines on which two eigenvalues have the same size, those of the dominant ones solid."""
    for (line,), points in groups_of(rows, "line"):
        if line:
            dominant = int(line) % 2 == 1
            order = np.argsort(points.number("theta"))
            ax.plot(points.number("theta")[order], points.number("lambda")[order], color=colour,
                    linewidth=0.9 if dominant else 0.5, linestyle="-" if dominant else (0, (2, 2)))


def name_domain(ax, theta, lam, mask, text, colour):
    """Writes a name where the domain is widest: in the middle of the largest distance to its border."""
    if not mask.any():
        return
    row, column = max(np.argwhere(mask), key=lambda at: clearance(mask, *at))
    ax.text(theta[column], lam[row], f"${text}$", ha="center", va="center",
            bbox={"facecolor": colour, "edgecolor": "none", "pad": 1.5})


def clearance(mask, row, column):
    """The number of cells of the domain on the shortest of the four ways to its border."""
    ways = (mask[row::-1, column], mask[row:, column], mask[row, column::-1], mask[row, column:])
    return min(len(way) if way.all() else int(np.argmin(way)) for way in ways)
