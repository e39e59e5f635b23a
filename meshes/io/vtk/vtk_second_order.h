// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "meshes/io/node_order.h"

namespace smoothfem {

/// Hexahedra and prisms with nodes on their faces (VTK, "Cell type definitions").
inline constexpr NodeOrder vtk_hexahedron_27 =
    with_middles(hexahedron_20, 8, {{0, 7}, {1, 6}, {0, 5}, {3, 6}, {0, 2}, {4, 6}}, true);
inline constexpr NodeOrder vtk_prism_18 =
    with_middles(prism_15, 6, {{0, 4}, {1, 5}, {2, 3}}, false);

/// VTK's cells of second order: the quadratic ones, which are written, then the Lagrange ones of
/// order 2. VTK has no pyramid with 14 nodes.
inline constexpr std::array<FormatElement, 19> vtk_second_order_types{
    {{21, 1, 2, line_3},
     {22, 2, 3, triangle_6},
     {34, 2, 3, triangle_7},
     {23, 2, 4, quadrilateral_8},
     {28, 2, 4, quadrilateral_9},
     {24, 3, 4, tetrahedron_10},
     {27, 3, 5, pyramid_13},
     {26, 3, 6, prism_15},
     {32, 3, 6, vtk_prism_18},
     {25, 3, 8, hexahedron_20},
     {29, 3, 8, vtk_hexahedron_27},
     {68, 1, 2, line_3},
     {69, 2, 3, triangle_6},
     {69, 2, 3, triangle_7},
     {70, 2, 4, quadrilateral_9},
     {71, 3, 4, tetrahedron_10},
     {74, 3, 5, pyramid_13},
     {73, 3, 6, vtk_prism_18},
     {72, 3, 8, vtk_hexahedron_27}}};

/// Positions in rows of Lagrange hexahedra whose nodes older versions of VTK (before 9.1) list the
/// other way round: those of the edges between corners 2 and 6, and 3 and 7.
inline constexpr std::array<std::size_t, 2> vtk_swapped_edges{18, 19};

}  // namespace smoothfem
