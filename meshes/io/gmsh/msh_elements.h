// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "meshes/io/node_order.h"

namespace smoothfem {

/// A linear element type of Gmsh, with its nodes in the order of volume_elements.h.
struct MshElementType {
  int number;  ///< in files
  int dimension;
  std::size_t n_corners;
};

/// Point, line, triangle, quadrilateral, tetrahedron, hexahedron, prism, pyramid.
constexpr std::array<MshElementType, 8> msh_element_types{
    {{15, 0, 1}, {1, 1, 2}, {2, 2, 3}, {3, 2, 4}, {4, 3, 4}, {5, 3, 8}, {6, 3, 6}, {7, 3, 5}}};

/// Gmsh's orders of nodes on edges (reference manual of Gmsh, "Node ordering").
inline constexpr NodeOrder msh_tetrahedron_10 =
    node_order(3, 4, {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}});
inline constexpr NodeOrder msh_pyramid_13 =
    node_order(3, 5, {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 4}, {2, 3}, {2, 4}, {3, 4}});
inline constexpr NodeOrder msh_prism_15 =
    node_order(3, 6, {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}});
inline constexpr NodeOrder msh_hexahedron_20 = node_order(3, 8,
                                                          {{0, 1},
                                                           {0, 3},
                                                           {0, 4},
                                                           {1, 2},
                                                           {1, 5},
                                                           {2, 3},
                                                           {2, 6},
                                                           {3, 7},
                                                           {4, 5},
                                                           {4, 7},
                                                           {5, 6},
                                                           {6, 7}});

/// Types of second order.
inline constexpr std::array<FormatElement, 11> msh_second_order_types{
    {{8, 1, 2, line_3},
     {9, 2, 3, triangle_6},
     {16, 2, 4, quadrilateral_8},
     {10, 2, 4, quadrilateral_9},
     {11, 3, 4, msh_tetrahedron_10},
     {17, 3, 8, msh_hexahedron_20},
     {12, 3, 8,
      with_middles(msh_hexahedron_20, 8, {{0, 2}, {0, 5}, {0, 7}, {1, 6}, {2, 7}, {4, 6}}, true)},
     {18, 3, 6, msh_prism_15},
     {13, 3, 6, with_middles(msh_prism_15, 6, {{0, 4}, {0, 5}, {1, 5}}, false)},
     {19, 3, 5, msh_pyramid_13},
     {14, 3, 5, with_middles(msh_pyramid_13, 5, {{0, 2}}, false)}}};

/// Type of an element in a file, linear or of second order.
struct MshType {
  int number = 0;  ///< in files; 0 if Gmsh has no such element
  int dimension = 0;
  std::size_t n_corners = 0, n_nodes = 0;
  const NodeOrder* order = nullptr;  ///< of second order; null: that of volume_elements.h
};

constexpr MshType msh_type(const MshElementType& type) {
  return {type.number, type.dimension, type.n_corners, type.n_corners, nullptr};
}
constexpr MshType msh_type(const FormatElement* type) {
  if (!type) return {};
  return {type->number, type->dimension, type->n_corners, type->order.size, &type->order};
}

/// Returns the type of a number; without a number if it cannot be read.
constexpr MshType msh_type(int number) {
  for (const MshElementType& type : msh_element_types)
    if (type.number == number) return msh_type(type);
  return msh_type(find_type(msh_second_order_types, number));
}

/// Returns the type of elements with so many nodes; without a number if there is none.
constexpr MshType msh_type(int dimension, std::size_t n_corners, std::size_t n_midside) {
  if (n_midside > 0)
    return msh_type(find_type(msh_second_order_types, dimension, n_corners, n_midside));
  for (const MshElementType& type : msh_element_types)
    if (type.dimension == dimension && type.n_corners == n_corners) return msh_type(type);
  return {};
}

/// Returns all numbers, those of linear elements first.
inline std::vector<int> msh_type_numbers() {
  std::vector<int> numbers;
  for (const MshElementType& type : msh_element_types) numbers.push_back(type.number);
  for (const FormatElement& type : msh_second_order_types) numbers.push_back(type.number);
  return numbers;
}

/// Returns the number of components, 1, 3 or 9, that Gmsh shows data with n components as; 0 if
/// there are too many.
constexpr std::size_t msh_components(std::size_t n) {
  return n <= 1 ? n : n <= 3 ? 3 : n <= 9 ? 9 : 0;
}

}  // namespace smoothfem
