# SPDX-License-Identifier: GPL-3.0-or-later
"""VTK's numbers of the types of cells, and what a reader calls them."""

# Planar cells whose connectivity walks around the cell: VTK_TRIANGLE, VTK_POLYGON, VTK_QUAD.
PLANAR_CELL_TYPES = {5: "triangle", 7: "polygon", 9: "quadrilateral"}
# VTK_TETRA, VTK_HEXAHEDRON, VTK_WEDGE, VTK_PYRAMID.
VOLUME_CELL_TYPES = {10: "tetrahedron", 12: "hexahedron", 13: "prism", 14: "pyramid"}
# Cells of second order -> the type of their corners, which come first in a row; the number of corners; of all nodes.
SECOND_ORDER = {21: (3, 2, 3),  # VTK_QUADRATIC_EDGE
                22: (5, 3, 6), 34: (5, 3, 7),  # VTK_QUADRATIC_TRIANGLE, VTK_BIQUADRATIC_TRIANGLE
                23: (9, 4, 8), 28: (9, 4, 9),  # VTK_QUADRATIC_QUAD, VTK_BIQUADRATIC_QUAD
                24: (10, 4, 10),  # VTK_QUADRATIC_TETRA
                25: (12, 8, 20), 29: (12, 8, 27),  # VTK_QUADRATIC_HEXAHEDRON, VTK_TRIQUADRATIC_HEXAHEDRON
                26: (13, 6, 15), 32: (13, 6, 18),  # VTK_QUADRATIC_WEDGE, VTK_BIQUADRATIC_QUADRATIC_WEDGE
                27: (14, 5, 13)}  # VTK_QUADRATIC_PYRAMID
# VTK_VERTEX, VTK_POLY_VERTEX, VTK_LINE and VTK_POLY_LINE, which carry labels, and those above.
CELL_DIMENSIONS = {1: 0, 2: 0, 3: 1, 4: 1, **dict.fromkeys(PLANAR_CELL_TYPES, 2),
                   **dict.fromkeys(VOLUME_CELL_TYPES, 3)}
CELL_DIMENSIONS |= {kind: CELL_DIMENSIONS[corners] for kind, (corners, _, _) in SECOND_ORDER.items()}
CELL_NAMES = (*PLANAR_CELL_TYPES.values(), *VOLUME_CELL_TYPES.values())
ANY_CELL = "cell"  # where it is not known of which type

PLURALS = {"tetrahedron": "tetrahedra", "hexahedron": "hexahedra"}


def counted(count, name):
    """'1 prism', '10,600 hexahedra'."""
    return f"{count:,} {name if count == 1 else PLURALS.get(name, name + 's')}"
