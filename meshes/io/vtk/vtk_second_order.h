// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "meshes/io/node_order.h"

namespace smoothfem {

/// Hexahedra and prisms with nodes on their faces (VTK, "Cell type definitions").
inline constexpr NodeOrder vtk_hexahedron_27 =
    with_middles(hexahedron_20, 8, {{0, 7}, {1, 6}, {0, 5}, {3, 6}, {0, 2}, {4, 6}}, true);
inline constexpr NodeOrder vtk_prism_18 = own_order(18);

/// VTK's quadratic cells. It has no pyramid with 14 nodes.
inline constexpr std::array<FormatElement, 11> vtk_quadratic_types{{{21, 1, 2, line_3},
                                                                    {22, 2, 3, triangle_6},
                                                                    {34, 2, 3, triangle_7},
                                                                    {23, 2, 4, quadrilateral_8},
                                                                    {28, 2, 4, quadrilateral_9},
                                                                    {24, 3, 4, tetrahedron_10},
                                                                    {27, 3, 5, pyramid_13},
                                                                    {26, 3, 6, prism_15},
                                                                    {32, 3, 6, vtk_prism_18},
                                                                    {25, 3, 8, hexahedron_20},
                                                                    {29, 3, 8, vtk_hexahedron_27}}};

/// VTK's Lagrange cells of order 2, which are read only.
inline constexpr std::array<FormatElement, 8> vtk_lagrange_types{{{68, 1, 2, line_3},
                                                                  {69, 2, 3, triangle_6},
                                                                  {69, 2, 3, triangle_7},
                                                                  {70, 2, 4, quadrilateral_9},
                                                                  {71, 3, 4, tetrahedron_10},
                                                                  {74, 3, 5, pyramid_13},
                                                                  {73, 3, 6, vtk_prism_18},
                                                                  {72, 3, 8, vtk_hexahedron_27}}};

/// A pyramid of meshio that VTK does not have.
inline constexpr FormatElement meshio_pyramid_14{0, 3, 5, own_order(14)};

/// Returns VTK's quadratic or Lagrange cell with so many nodes (0: any); null if it is another one.
constexpr const FormatElement* find_vtk_type(int number, std::size_t n_nodes = 0) {
  const FormatElement* quadratic = find_type(vtk_quadratic_types, number, n_nodes);
  return quadratic ? quadratic : find_type(vtk_lagrange_types, number, n_nodes);
}

/// Returns the cell of meshio with these nodes, which lists them as VTK does; null if it has none.
constexpr const FormatElement* find_meshio_type(int dimension, std::size_t n_corners,
                                                std::size_t n_midside) {
  const FormatElement* found = find_type(vtk_quadratic_types, dimension, n_corners, n_midside);
  return found ? found
               : find_type(std::span(&meshio_pyramid_14, 1), dimension, n_corners, n_midside);
}

/// Positions in rows of Lagrange hexahedra whose nodes older versions of VTK (before 9.1) list the
/// other way round: those of the edges between corners 2 and 6, and 3 and 7.
inline constexpr std::array<std::size_t, 2> vtk_swapped_edges{18, 19};

}  // namespace smoothfem
