// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vtkCellType.h>

#include <array>

#include "meshes/io/node_order.h"

namespace smoothfem {

/// Hexahedra and prisms with nodes on their faces (VTK, "Cell type definitions").
inline constexpr NodeOrder vtk_hexahedron_27 =
    with_middles(hexahedron_20, 8, {{0, 7}, {1, 6}, {0, 5}, {3, 6}, {0, 2}, {4, 6}}, true);
inline constexpr NodeOrder vtk_prism_18 =
    with_middles(prism_15, 6, {{0, 4}, {1, 5}, {2, 3}}, false);

/// VTK's cells of second order. The first ones of their kind are written. VTK has no pyramid with
/// 14 nodes.
inline constexpr std::array<FormatElement, 19> vtk_second_order_types{
    {{VTK_QUADRATIC_EDGE, 1, 2, line_3},
     {VTK_QUADRATIC_TRIANGLE, 2, 3, triangle_6},
     {VTK_BIQUADRATIC_TRIANGLE, 2, 3, triangle_7},
     {VTK_QUADRATIC_QUAD, 2, 4, quadrilateral_8},
     {VTK_BIQUADRATIC_QUAD, 2, 4, quadrilateral_9},
     {VTK_QUADRATIC_TETRA, 3, 4, tetrahedron_10},
     {VTK_QUADRATIC_PYRAMID, 3, 5, pyramid_13},
     {VTK_QUADRATIC_WEDGE, 3, 6, prism_15},
     {VTK_BIQUADRATIC_QUADRATIC_WEDGE, 3, 6, vtk_prism_18},
     {VTK_QUADRATIC_HEXAHEDRON, 3, 8, hexahedron_20},
     {VTK_TRIQUADRATIC_HEXAHEDRON, 3, 8, vtk_hexahedron_27},
     {VTK_LAGRANGE_CURVE, 1, 2, line_3},
     {VTK_LAGRANGE_TRIANGLE, 2, 3, triangle_6},
     {VTK_LAGRANGE_TRIANGLE, 2, 3, triangle_7},
     {VTK_LAGRANGE_QUADRILATERAL, 2, 4, quadrilateral_9},
     {VTK_LAGRANGE_TETRAHEDRON, 3, 4, tetrahedron_10},
     {VTK_LAGRANGE_PYRAMID, 3, 5, pyramid_13},
     {VTK_LAGRANGE_WEDGE, 3, 6, vtk_prism_18},
     {VTK_LAGRANGE_HEXAHEDRON, 3, 8, vtk_hexahedron_27}}};

/// Positions in rows of Lagrange hexahedra whose nodes older versions of VTK (before 9.1) list the
/// other way round: those of the edges between corners 2 and 6, and 3 and 7.
inline constexpr std::array<std::size_t, 2> vtk_swapped_edges{18, 19};

}  // namespace smoothfem
