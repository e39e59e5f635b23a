// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace smoothfem {

/// The points that determine a cell's mapping. Those of a straight-sided cell are its vertices.
/// Curved cells (triangle 7, quadrilateral 9, tetrahedron 10, pyramid 14, prism 18, hexahedron 27
/// points) have one point more in the middle of each edge, of each quadrilateral face, and of the
/// cell if it is a triangle, quadrilateral or hexahedron. Their order is that of midside_nodes.h,
/// but vertices are in deal.II's order.
struct MappingPoints {
  /// The vertices in whose middle each point is.
  std::vector<std::vector<std::size_t>> places;
  /// For each point the weighted sum of earlier points that replaces it in a cell without a node
  /// there; empty at vertices. The middle of an edge is then the mean of its ends. The middle of a
  /// face or cell is that of the transfinite interpolation of its edges and faces. It equals the
  /// own mapping of cells without such nodes (TRI6, QUAD8, HEX20, PRISM15).
  std::vector<std::vector<std::pair<std::size_t, double>>> substitutes;

  std::size_t size() const { return places.size(); }
  /// Returns the position of a point in the list; size() if there is none at these vertices.
  std::size_t find(const std::vector<std::size_t>& place) const;
};

/// Returns deal.II's position of a vertex, or the vertex at that position: it has the vertices of
/// quadrilaterals in lexicographic order, also in pyramids and hexahedra.
constexpr std::size_t deal_ii_position(int dim, std::size_t n_vertices, std::size_t k) {
  const bool lexicographic = n_vertices == 4 ? dim == 2 : n_vertices == 5 || n_vertices == 8;
  return lexicographic && (k & 2U) != 0 ? k ^ 1U : k;
}

/// Returns the points of a cell or facet. dim: its dimension, 1 to 3. n_vertices: of it.
MappingPoints mapping_points(int dim, std::size_t n_vertices, bool curved);

}  // namespace smoothfem
