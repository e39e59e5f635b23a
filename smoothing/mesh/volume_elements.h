// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>

#include "smoothing/mesh/element_type.h"

/// The four volume elements: node order, edges, faces, node simplices and duals, after Section 3.1
/// and Fig. 3.5 of the thesis, counted from 0. No other file has such tables.
///
///   tetrahedron          pyramid            prism           hexahedron
///
///        3                  4              3-------5        7-------6
///       /|\               //|\             |\     /|       /|      /|
///      / | \             / / \ \           | \   / |      / |     / |
///     /  |  \           3-/---\-2          |   4   |     4-------5  |
///    0---|---2         / /     \/          0---|---2     |  3----|--2
///     \  |  /         0---------1           \  |  /      | /     | /
///      \ | /                                 \ | /       |/      |/
///        1                                     1         0-------1
///
/// Orientation: the nodes in each row of `corners` span a positive volume. In the prism 0, 1, 2 run
/// counterclockwise seen from 3, 4, 5, as in Gmsh; VTK's wedge has the opposite order. In pyramid
/// and hexahedron 0, 1, 2, 3 run counterclockwise seen from the nodes above.

namespace smoothfem {

using LocalIndex = std::uint8_t;

/// Nodes of a face or a dual face; triangles do not use the fourth entry.
struct LocalFace {
  std::array<LocalIndex, 4> nodes;
  LocalIndex size;

  constexpr std::span<const LocalIndex> indices() const { return {nodes.data(), size}; }
};
constexpr LocalFace local_triangle(LocalIndex a, LocalIndex b, LocalIndex c) {
  return {{a, b, c, 0}, 3};
}
constexpr LocalFace local_quadrilateral(LocalIndex a, LocalIndex b, LocalIndex c, LocalIndex d) {
  return {{a, b, c, d}, 4};
}

using LocalEdge = std::array<LocalIndex, 2>;
/// A node and its three neighbours: a node simplex (thesis, Section 3.1, tuples N).
using LocalSimplex = std::array<LocalIndex, 4>;

/// Data of the simplex that W spans in the regular element with edges of length one, for the mean
/// ratio: the inverse of W' W, and the determinant of W.
struct RegularSimplex {
  double determinant;
  std::array<std::array<double, 3>, 3> inverse_gram;
};

/// Tables of the volume element with n nodes. `faces` (tuples F) are ordered so that their normals
/// point outwards. `dual_faces[k]` (tuples F with a bar) lists the faces whose means form the dual
/// face of node k.
template <std::size_t n>
struct VolumeElement;

template <>
struct VolumeElement<4> {
  static constexpr ElementType type = ElementType::tetrahedron;
  static constexpr std::array<LocalEdge, 6> edges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
  static constexpr std::array<LocalFace, 4> faces{local_triangle(0, 2, 1), local_triangle(0, 1, 3),
                                                  local_triangle(1, 2, 3), local_triangle(2, 0, 3)};
  static constexpr std::array<LocalSimplex, 1> corners{{{0, 1, 2, 3}}};
  static constexpr std::array<LocalFace, 4> dual_faces{
      local_triangle(0, 1, 3), local_triangle(0, 2, 1), local_triangle(0, 3, 2),
      local_triangle(1, 2, 3)};
  static constexpr RegularSimplex regular{
      0.5 * std::numbers::sqrt2, {{{1.5, -0.5, -0.5}, {-0.5, 1.5, -0.5}, {-0.5, -0.5, 1.5}}}};
};

template <>
struct VolumeElement<5> {
  static constexpr ElementType type = ElementType::pyramid;
  static constexpr std::array<LocalEdge, 8> edges{
      {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}};
  static constexpr std::array<LocalFace, 5> faces{local_quadrilateral(0, 3, 2, 1),
                                                  local_triangle(0, 1, 4), local_triangle(1, 2, 4),
                                                  local_triangle(2, 3, 4), local_triangle(3, 0, 4)};
  static constexpr std::array<LocalSimplex, 4> corners{
      {{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}}};
  static constexpr std::array<LocalFace, 5> dual_faces{
      local_triangle(0, 1, 4), local_triangle(0, 2, 1), local_triangle(0, 3, 2),
      local_triangle(0, 4, 3), local_quadrilateral(1, 2, 3, 4)};
  static constexpr RegularSimplex regular{
      0.5 * std::numbers::sqrt2, {{{1.5, 0.5, -1.0}, {0.5, 1.5, -1.0}, {-1.0, -1.0, 2.0}}}};
};

template <>
struct VolumeElement<6> {
  static constexpr ElementType type = ElementType::prism;
  static constexpr std::array<LocalEdge, 9> edges{
      {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}};
  static constexpr std::array<LocalFace, 5> faces{
      local_triangle(0, 2, 1), local_quadrilateral(0, 1, 4, 3), local_quadrilateral(1, 2, 5, 4),
      local_quadrilateral(2, 0, 3, 5), local_triangle(3, 4, 5)};
  static constexpr std::array<LocalSimplex, 6> corners{
      {{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5}, {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}}};
  static constexpr std::array<LocalFace, 6> dual_faces{
      local_triangle(0, 1, 3), local_triangle(0, 2, 1), local_triangle(0, 3, 2),
      local_triangle(4, 3, 1), local_triangle(4, 1, 2), local_triangle(4, 2, 3)};
  static constexpr RegularSimplex regular{
      0.5 * std::numbers::sqrt3,
      {{{4.0 / 3.0, -2.0 / 3.0, 0.0}, {-2.0 / 3.0, 4.0 / 3.0, 0.0}, {0.0, 0.0, 1.0}}}};
};

template <>
struct VolumeElement<8> {
  static constexpr ElementType type = ElementType::hexahedron;
  static constexpr std::array<LocalEdge, 12> edges{{{0, 1},
                                                    {1, 2},
                                                    {2, 3},
                                                    {3, 0},
                                                    {4, 5},
                                                    {5, 6},
                                                    {6, 7},
                                                    {7, 4},
                                                    {0, 4},
                                                    {1, 5},
                                                    {2, 6},
                                                    {3, 7}}};
  static constexpr std::array<LocalFace, 6> faces{
      local_quadrilateral(0, 3, 2, 1), local_quadrilateral(0, 1, 5, 4),
      local_quadrilateral(1, 2, 6, 5), local_quadrilateral(2, 3, 7, 6),
      local_quadrilateral(3, 0, 4, 7), local_quadrilateral(4, 5, 6, 7)};
  static constexpr std::array<LocalSimplex, 8> corners{{{0, 3, 4, 1},
                                                        {1, 0, 5, 2},
                                                        {2, 1, 6, 3},
                                                        {3, 2, 7, 0},
                                                        {4, 7, 5, 0},
                                                        {5, 4, 6, 1},
                                                        {6, 5, 7, 2},
                                                        {7, 6, 4, 3}}};
  static constexpr std::array<LocalFace, 8> dual_faces{
      local_triangle(0, 1, 4), local_triangle(0, 2, 1), local_triangle(0, 3, 2),
      local_triangle(0, 4, 3), local_triangle(5, 4, 1), local_triangle(5, 1, 2),
      local_triangle(5, 2, 3), local_triangle(5, 3, 4)};
  static constexpr RegularSimplex regular{1.0,
                                          {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}}};
};

/// Provides the same tables for element types that are known only at run time.
struct VolumeElementTables {
  std::span<const LocalEdge> edges;
  std::span<const LocalFace> faces;
  std::span<const LocalSimplex> corners;
};

namespace detail {
template <std::size_t n>
inline constexpr VolumeElementTables volume_tables{VolumeElement<n>::edges, VolumeElement<n>::faces,
                                                   VolumeElement<n>::corners};
}  // namespace detail

/// n_nodes: 4, 5, 6 or 8.
constexpr const VolumeElementTables& volume_element(std::size_t n_nodes) {
  return n_nodes == 4   ? detail::volume_tables<4>
         : n_nodes == 5 ? detail::volume_tables<5>
         : n_nodes == 6 ? detail::volume_tables<6>
                        : detail::volume_tables<8>;
}

/// Calls visit(a, b) for the edges of a cell with n_nodes nodes in a mesh of dimension dim, with
/// the positions of their ends. Sides of planar cells run around the cell.
template <class Visit>
constexpr void for_each_edge(int dim, std::size_t n_nodes, const Visit& visit) {
  if (dim == 2) {
    for (std::size_t k = 0; k < n_nodes; ++k) visit(k, k + 1 == n_nodes ? 0 : k + 1);
  } else {
    for (const auto& [a, b] : volume_element(n_nodes).edges) visit(std::size_t{a}, std::size_t{b});
  }
}

/// Calls visit(face) for the faces of a volume cell that have four nodes.
template <class Visit>
constexpr void for_each_quadrilateral_face(std::size_t n_nodes, const Visit& visit) {
  for (const LocalFace& face : volume_element(n_nodes).faces)
    if (face.size == 4) visit(face);
}

/// Calls visit(positions) for the facets of a cell, with a range of positions in the cell. Facets
/// are the sides of planar cells or the faces of volume cells, the latter with outward normals.
template <class Visit>
constexpr void for_each_facet(int dim, std::size_t n_nodes, const Visit& visit) {
  if (dim == 2) {
    for (std::size_t k = 0; k < n_nodes; ++k) {
      const std::array<std::size_t, 2> side{k, k + 1 == n_nodes ? 0 : k + 1};
      visit(std::span<const std::size_t>(side));
    }
  } else {
    for (const LocalFace& face : volume_element(n_nodes).faces) {
      std::array<std::size_t, 4> positions{};
      for (std::size_t k = 0; k < face.size; ++k) positions[k] = face.nodes[k];
      visit(std::span<const std::size_t>(positions.data(), face.size));
    }
  }
}

}  // namespace smoothfem
