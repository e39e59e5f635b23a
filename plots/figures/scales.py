# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertical scales of diagrams, and room for their labels."""

from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

# Panels are logarithmic from this ratio of largest to smallest number on: the thesis' own figure of
# errors spans a factor of 7 at most and is linear, errors of quadratic elements span more than 20.
LOGARITHMIC_FROM = 12.0

# A linear axis begins at zero if the least number is at most this part of the largest one.
FROM_ZERO = 0.2

TICKS_OF_AN_INCH = 1.9  # labels of a horizontal axis such as 0.0025 are half an inch wide

# Inches: around labels, and the height of a line of them.
PAD, LABEL_HEIGHT = 0.06, 0.18


def spans_magnitudes(values):
    """True if finite numbers need a logarithmic axis."""
    return len(values) > 0 and values.min() > 0 and values.max() > LOGARITHMIC_FROM * values.min()


def scale_values(ax, values, logarithmic, limits=(None, None)):
    """A logarithmic axis that holds the positive ones of finite numbers, or a linear one that fits them. It begins at zero if
    their least is near zero. limits: (from, to), None where the numbers decide."""
    positive = values[values > 0]
    if logarithmic and len(positive):
        ax.set_yscale("log", nonpositive="mask")
        low, high = (each if end is None else end for each, end in zip((positive.min(), positive.max()), limits))
        label_logarithmic(ax, low, high)
    elif len(values):
        low, high = values.min(), values.max()
        low = min(0.0, low) if low <= FROM_ZERO * abs(high) else low
        # A small margin below: lowest qualities are often as good as zero and would lie on the axis.
        extent = high - low or abs(high) or 1.0
        ax.set_ylim(low - 0.06 * extent, high + 0.06 * extent)
    if any(end is not None for end in limits):
        ax.set_ylim(*limits)


def label_logarithmic(ax, low, high):
    """Plain numbers instead of powers of ten where they are short, with 2 and 5 if the range is small."""
    if low < 1e-3 or high > 1e4:
        return
    plain = FuncFormatter(lambda value, _: f"{value:g}")
    ax.yaxis.set_major_formatter(plain)
    if high / low < 300:
        ax.yaxis.set_minor_locator(LogLocator(subs=(2, 5)))
        ax.yaxis.set_minor_formatter(plain)
        ax.tick_params(axis="y", which="minor", labelsize=8)
    else:
        ax.yaxis.set_minor_formatter(NullFormatter())


def space_ticks(ax, whole=False):
    """So few labels on a linear horizontal axis that they do not touch; whole: only whole numbers."""
    if ax.get_xscale() == "linear":
        inches = ax.get_position().width * ax.figure.get_figwidth()
        ax.xaxis.set_major_locator(MaxNLocator(nbins=max(2, min(9, int(TICKS_OF_AN_INCH * inches))), integer=whole,
                                               steps=[1, 2, 5, 10]))


def make_room_for_labels(figure, axes, right=0.18):
    """Moves columns of panels so far apart that the labels of their vertical axes have room; `axes` as
    an array (rows, columns). The labels of the first column end at the same distance from the panels."""
    renderer = figure.canvas.get_renderer()
    widths = [max(width_of_tick_labels(ax, renderer) for ax in column) / figure.dpi for column in axes.T]
    width, n = figure.get_figwidth(), len(widths)
    left = widths[0] + 2 * PAD + LABEL_HEIGHT * max(1 + ax.get_ylabel().count("\n") for ax in axes[:, 0])
    gap = max(widths[1:], default=0.0) + 2 * PAD
    panel = (width - left - right - (n - 1) * gap) / n
    figure.subplots_adjust(left=left / width, right=1 - right / width, wspace=gap / panel)
    for ax in axes[:, 0]:
        ax.yaxis.set_label_coords(-(widths[0] + PAD) / panel, 0.5)


def width_of_tick_labels(ax, renderer):
    """The distance in pixels by which labels of the vertical axis extend to the left of a panel."""
    ax.yaxis.label.set_visible(False)
    box = ax.yaxis.get_tightbbox(renderer)
    ax.yaxis.label.set_visible(True)
    return 0.0 if box is None else max(0.0, ax.get_window_extent(renderer).x0 - box.x0)
