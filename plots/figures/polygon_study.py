# SPDX-License-Identifier: GPL-3.0-or-later
"""Selection and names of the figures of a polygon study."""

from .domains import draw_domains
from .planned import plan_numbered
from .polygons import draw_decomposition, draw_limits, draw_sequences
from .side_ratios import draw_side_ratios

# Name -> (number in the thesis or empty, title, how to draw it).
FIGURES = {
    "limits": ("2_3", "limits along the base angle", draw_limits),
    "isosceles_sequences": ("2_5", "sequences, isosceles triangles",
                            lambda results: draw_sequences(results, "isosceles", False)),
    "decomposition": ("2_10", "eigenpolygons", draw_decomposition),
    "domains": ("2_11", "domains of dominant eigenvalues", draw_domains),
    "combined_sequences": ("2_12", "sequences, combined transformation",
                           lambda results: draw_sequences(results, "combined", True)),
    "side_ratios": ("", "convergence of side ratios", draw_side_ratios),
}


def plan_polygon_figures(results):
    """All figures."""
    return plan_numbered(results, FIGURES)
