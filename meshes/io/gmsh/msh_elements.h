// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace smoothfem {

/// An element type of Gmsh whose nodes are its corners, in the order of volume_elements.h.
struct MshElementType {
  int number;  ///< in files
  int dimension;
  std::size_t n_nodes;
};

/// Point, line, triangle, quadrilateral, tetrahedron, hexahedron, prism, pyramid.
constexpr std::array<MshElementType, 8> msh_element_types{
    {{15, 0, 1}, {1, 1, 2}, {2, 2, 3}, {3, 2, 4}, {4, 3, 4}, {5, 3, 8}, {6, 3, 6}, {7, 3, 5}}};

/// Returns the type of a number; null for all others, for example those with nodes on edges.
constexpr const MshElementType* msh_element_type(int number) {
  const auto* found = std::find_if(msh_element_types.begin(), msh_element_types.end(),
                                   [&](const auto& type) { return type.number == number; });
  return found == msh_element_types.end() ? nullptr : found;
}

/// Returns the type of elements with n_nodes nodes; null if there is no such type.
constexpr const MshElementType* msh_element_type(int dimension, std::size_t n_nodes) {
  const auto* found = std::find_if(
      msh_element_types.begin(), msh_element_types.end(),
      [&](const auto& type) { return type.dimension == dimension && type.n_nodes == n_nodes; });
  return found == msh_element_types.end() ? nullptr : found;
}

/// Returns the number of components, 1, 3 or 9, that Gmsh shows data with n components as; 0 if
/// there are too many.
constexpr std::size_t msh_components(std::size_t n) {
  return n <= 1 ? n : n <= 3 ? 3 : n <= 9 ? 9 : 0;
}

}  // namespace smoothfem
