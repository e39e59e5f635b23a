// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "smoothing/mesh/compressed_rows.h"
#include "smoothing/mesh/point.h"
#include "smoothing/mesh/volume_elements.h"

/// Nodes of elements of second order besides their corners. A row of nodes, here and in files of
/// most formats, begins with the corners in the order of volume_elements.h. Then follow the
/// midside nodes: one for each edge, in the order of for_each_edge(); one for each quadrilateral
/// face, in the order of the tables, if the element has such nodes; and the node in the middle of
/// the cell, if it has one. In planar cells the last one is that of the face.
///
///   nodes beyond the corners            edges   faces   cell   name
///   edge (2 corners)                                     1     line of three nodes
///   triangle                  3, 4       3               0, 1  TRI6, TRI7
///   quadrilateral             4, 5       4               0, 1  QUAD8, QUAD9
///   tetrahedron               6          6                     TET10
///   pyramid                   8, 9       8       0, 1          PYRAMID13, PYRAMID14
///   prism                     9, 12      9       0, 3          PRISM15, PRISM18
///   hexahedron               12, 19     12       0, 6    0, 1  HEX20, HEX27

namespace smoothfem {

/// Number of midside nodes of an element, by where they are.
struct MidsideCounts {
  std::size_t edges = 0, faces = 0, cell = 0;

  constexpr std::size_t sum() const { return edges + faces + cell; }
  constexpr bool operator==(const MidsideCounts&) const = default;
};

/// The elements with midside nodes.
struct MidsideKind {
  int dim;
  std::size_t n_corners;
  MidsideCounts counts;
};
inline constexpr std::array<MidsideKind, 12> midside_kinds{{{1, 2, {0, 0, 1}},
                                                            {2, 3, {3, 0, 0}},
                                                            {2, 3, {3, 0, 1}},
                                                            {2, 4, {4, 0, 0}},
                                                            {2, 4, {4, 0, 1}},
                                                            {3, 4, {6, 0, 0}},
                                                            {3, 5, {8, 0, 0}},
                                                            {3, 5, {8, 1, 0}},
                                                            {3, 6, {9, 0, 0}},
                                                            {3, 6, {9, 3, 0}},
                                                            {3, 8, {12, 0, 0}},
                                                            {3, 8, {12, 6, 1}}}};

/// Returns where the n_midside nodes of an element lie. dim: its dimension, 1 to 3. All counts are
/// 0 if there is no such element of second order.
constexpr MidsideCounts midside_counts(int dim, std::size_t n_corners, std::size_t n_midside) {
  for (const MidsideKind& kind : midside_kinds)
    if (kind.dim == dim && kind.n_corners == n_corners && kind.counts.sum() == n_midside)
      return kind.counts;
  return {};
}

/// The midside nodes of a mesh's elements, a row for each. Rows of linear elements are empty.
struct MidsideNodes {
  CompressedRows<NodeIndex> of_cells, of_facets;         ///< cells, labelled facets
  std::array<CompressedRows<NodeIndex>, 3> of_others{};  ///< FileContent::others, by dimension

  bool operator==(const MidsideNodes&) const = default;
};

/// The edge, face or cell that a midside node belongs to: its corners, ascending, then no_corner. A
/// hexahedron is known by two opposite corners.
using MidsidePlace = std::array<NodeIndex, 4>;
constexpr NodeIndex no_corner = std::numeric_limits<NodeIndex>::max();

/// Calls visit(place, node) for the midside nodes of an element in their order. dim: its
/// dimension, 1 to 3.
template <class Visit>
void for_each_midside_place(int dim, std::span<const NodeIndex> corners,
                            std::span<const NodeIndex> midside, const Visit& visit) {
  if (midside.empty()) return;
  const MidsideCounts counts = midside_counts(dim, corners.size(), midside.size());
  std::size_t next = 0;
  if (counts.edges > 0)
    for_each_edge(dim, corners.size(), [&](std::size_t a, std::size_t b) {
      const NodeIndex low = std::min(corners[a], corners[b]),
                      high = std::max(corners[a], corners[b]);  // without branches
      visit(MidsidePlace{low, high, no_corner, no_corner}, midside[next++]);
    });
  if (counts.faces > 0)
    for_each_quadrilateral_face(corners.size(), [&](const LocalFace& face) {
      MidsidePlace place;
      for (std::size_t k = 0; k < place.size(); ++k) place[k] = corners[face.nodes[k]];
      std::sort(place.begin(), place.end());
      visit(place, midside[next++]);
    });
  if (counts.cell == 0) return;
  MidsidePlace place{no_corner, no_corner, no_corner, no_corner};
  if (dim == 3) {
    place[0] = place[1] = std::min(corners[0], corners[6]);
    place[2] = place[3] = std::max(corners[0], corners[6]);
  } else {
    std::copy(corners.begin(), corners.end(), place.begin());
    std::sort(place.begin(), place.end());
  }
  visit(place, midside[next]);
}

/// Returns the midside nodes of an element whose corners change their order. dim: 2 or 3. midside:
/// before. corners: for each new position of a corner the old one.
std::vector<NodeIndex> reordered_midside(int dim, std::span<const NodeIndex> midside,
                                         std::span<const LocalIndex> corners);

/// Returns the midside nodes of facets: those of their sides in order, no_corner where there is
/// none, then that in their middle, if there is one. dim: of the cells. cells, midside: as below.
CompressedRows<NodeIndex> midside_of_facets(int dim, const CompressedRows<NodeIndex>& cells,
                                            const CompressedRows<NodeIndex>& midside,
                                            const CompressedRows<NodeIndex>& facets);

/// Throws CellError for the first cell whose midside nodes do not fit: their number is not one of
/// the table above, a node is a corner of a cell or lies on two edges, or an edge or a face has
/// another node in an earlier cell. dim: 2 or 3. cells: their corners, valid rows. midside: of the
/// cells.
void check_midside_nodes(int dim, std::size_t n_nodes, const CompressedRows<NodeIndex>& cells,
                         const CompressedRows<NodeIndex>& midside);

}  // namespace smoothfem
