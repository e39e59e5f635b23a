// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <type_traits>
#include <vector>

#include "smoothing/mesh/midside_nodes.h"
#include "smoothing/mesh/volume_elements.h"

/// Node orders of files that differ from those of volume_elements.h. The corners of tetrahedra,
/// pyramids and hexahedra have one order everywhere; of the formats known here only VTK's wedge
/// differs:
///
///         5                4
///        /|\              /|\       Inside, in Gmsh, Medit and Abaqus (left) the nodes 0, 1, 2 run
///       3---4            3---5      counterclockwise seen from 3, 4, 5. VTK_WEDGE (right) wants
///       | | |            | | |      the normal of 0, 1, 2 to point outwards, away from 3, 4, 5:
///       | 2 |            | 1 |      clockwise seen from there.
///       |/ \|            |/ \|
///       0---1            0---2
///
/// VTK's voxels and pixels list their nodes row by row.
///
///        6-------7
///       /|      /|          2---3
///      4-------5 |          |   |
///      | |     | |          0---1
///      | 2-----|-3
///      |/      |/
///      0-------1

namespace smoothfem {

/// Maps positions in a VTK row to nodes of volume_elements.h, and back: each map is its own
/// inverse.
inline constexpr std::array<LocalIndex, 6> vtk_wedge{0, 2, 1, 3, 5, 4};
inline constexpr std::array<LocalIndex, 4> vtk_pixel{0, 1, 3, 2};
inline constexpr std::array<LocalIndex, 8> vtk_voxel{0, 1, 3, 2, 4, 5, 7, 6};

/// Reorders a row that has as many indices as the order.
template <class Row, std::size_t n>
void permute(Row&& row, const std::array<LocalIndex, n>& order) {
  std::array<typename std::remove_reference_t<Row>::value_type, n> copy;
  std::copy_n(row.begin(), n, copy.begin());
  for (std::size_t k = 0; k < n; ++k) row[k] = copy[order[k]];
}

/// Order in which a format lists all nodes of an element of second order.
struct NodeOrder {
  /// Positions in a row of midside_nodes.h.
  std::array<LocalIndex, 27> positions{};
  LocalIndex size = 0;

  constexpr void add(std::size_t position) {
    positions[size++] = static_cast<LocalIndex>(position);
  }
  /// Changes a row of the format into one of midside_nodes.h.
  void from_file(std::span<NodeIndex> row) const {
    const auto listed = copy_of(row);
    for (std::size_t k = 0; k < size; ++k) row[positions[k]] = listed[k];
  }
  /// Changes a row of midside_nodes.h into one of the format.
  void to_file(std::span<NodeIndex> row) const {
    const auto former = copy_of(row);
    for (std::size_t k = 0; k < size; ++k) row[k] = former[positions[k]];
  }

 private:
  std::array<NodeIndex, 27> copy_of(std::span<const NodeIndex> row) const {
    std::array<NodeIndex, 27> copy{};
    std::copy_n(row.begin(), size, copy.begin());
    return copy;
  }
};

/// Returns the order of a format that lists the corners in the order of volume_elements.h, then the
/// nodes of these edges, by their corners. dim: 2 or 3.
constexpr NodeOrder node_order(int dim, std::size_t n_corners,
                               std::initializer_list<LocalEdge> edges) {
  NodeOrder order;
  for (std::size_t k = 0; k < n_corners; ++k) order.add(k);
  for (const auto& [a, b] : edges) {
    std::size_t position = n_corners;
    for_each_edge(dim, n_corners, [&, a = a, b = b](std::size_t p, std::size_t q) {
      if ((p == a && q == b) || (p == b && q == a)) order.add(position);
      ++position;
    });
  }
  return order;
}

/// Returns the order of a format that then lists the nodes of these quadrilateral faces, by two
/// opposite corners, and the node in the middle of the cell, if it has one. edges: the order of
/// corners and edges.
constexpr NodeOrder with_middles(const NodeOrder& edges, std::size_t n_corners,
                                 std::initializer_list<LocalEdge> faces, bool has_cell) {
  NodeOrder order = edges;
  for (const auto& [a, b] : faces) {
    std::size_t position = edges.size;
    for_each_quadrilateral_face(n_corners, [&, a = a, b = b](const LocalFace& face) {
      bool has_a = false, has_b = false;
      for (const LocalIndex k : face.nodes) {
        has_a = has_a || k == a;
        has_b = has_b || k == b;
      }
      if (has_a && has_b) order.add(position);
      ++position;
    });
  }
  if (has_cell) order.add(order.size);
  return order;
}

/// Returns the order of midside_nodes.h itself, which most formats have for most elements.
constexpr NodeOrder own_order(std::size_t n_nodes) {
  NodeOrder order;
  for (std::size_t k = 0; k < n_nodes; ++k) order.add(k);
  return order;
}
inline constexpr NodeOrder line_3 = own_order(3), triangle_6 = own_order(6),
                           triangle_7 = own_order(7), quadrilateral_8 = own_order(8),
                           quadrilateral_9 = own_order(9);
/// Orders of VTK and Abaqus.
inline constexpr NodeOrder tetrahedron_10 =
    node_order(3, 4, {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}});
inline constexpr NodeOrder pyramid_13 = own_order(13), prism_15 = own_order(15),
                           hexahedron_20 = own_order(20);

/// An element of second order in a format.
struct FormatElement {
  int number;  ///< of the format, for example VTK's
  int dimension;
  std::size_t n_corners;
  NodeOrder order;
};

/// Returns the first type of a number with so many nodes (0: any), or the one of an element; null
/// if there is none.
constexpr const FormatElement* find_type(std::span<const FormatElement> types, int number,
                                         std::size_t n_nodes = 0) {
  for (const FormatElement& type : types)
    if (type.number == number && (n_nodes == 0 || type.order.size == n_nodes)) return &type;
  return nullptr;
}
constexpr const FormatElement* find_type(std::span<const FormatElement> types, int dimension,
                                         std::size_t n_corners, std::size_t n_midside) {
  for (const FormatElement& type : types)
    if (type.dimension == dimension && type.n_corners == n_corners &&
        type.order.size == n_corners + n_midside)
      return &type;
  return nullptr;
}

}  // namespace smoothfem
