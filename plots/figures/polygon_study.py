# SPDX-License-Identifier: GPL-3.0-or-later
"""Which figures belong to a polygon study, and what they are called."""

from . import style
from .domains import draw_domains
from .polygons import draw_decomposition, draw_limits, draw_sequences
from .side_ratios import draw_side_ratios

# File name -> (title, how to draw it); numbers are those of the thesis.
FIGURES = {
    "figure_2_3_limits": ("limits along the base angle", draw_limits),
    "figure_2_5_isosceles_sequences": (
        "sequences, isosceles triangles", lambda results: draw_sequences(results, "isosceles", False)),
    "figure_2_10_decomposition": ("eigenpolygons", draw_decomposition),
    "figure_2_11_domains": ("domains of dominant eigenvalues", draw_domains),
    "figure_2_12_combined_sequences": (
        "sequences, combined transformation", lambda results: draw_sequences(results, "combined", True)),
    "figure_side_ratios": ("convergence of side ratios", draw_side_ratios),
}


def draw_polygon_figures(results):
    """Draws all figures into <folder>/figures; returns the paths."""
    style.apply_style()
    paths = []
    for name, (title, draw) in FIGURES.items():
        figure = draw(results)
        if figure is not None:
            paths += style.save_figure(figure, results.folder / "figures", name,
                                       f"{results.study_title}: {title}")
    return paths
