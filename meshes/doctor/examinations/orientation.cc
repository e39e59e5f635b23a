// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/doctor/examinations/orientation.h"

#include <algorithm>
#include <numeric>

#include "meshes/doctor/examinations/disjoint_sets.h"
#include "smoothing/geometry/cell_size.h"

namespace smoothfem {

namespace {

/// Sums over one piece of the mesh, for its cells as they are relative to its first cell.
struct PieceSums {
  double size = 0.0;              ///< total area or volume, if all were as the first cell
  std::ptrdiff_t n_as_first = 0;  ///< cells as the first one, minus the others
  bool is_one_sided = false;
};

bool is_negative_somewhere(const PlainCells& cells) {
  for (CellIndex c = 0; c < cells.cells.size(); ++c)
    if (signed_size(cells, c) < 0.0) return true;
  return false;
}

bool has_signs(const PlainCells& cells) {
  return cells.dim == 3 || cells.planar;
}

}  // namespace

double signed_size(const PlainCells& cells, CellIndex cell) {
  const auto nodes = cells.cells[cell];
  if (cells.dim == 2) {
    const Point<3> area = area_vector(nodes, cells.points);
    return 0.5 * (cells.planar ? area.z() : area.stableNorm());
  }
  double size = 0.0;
  with_corners<3>(nodes, cells.points.data(),
                  [&](auto corners) { size = signed_cell_size(corners); });
  return size;
}

Orientation find_reversed_cells(const PlainCells& cells) {
  if (has_signs(cells) && !is_negative_somewhere(cells)) return {};
  return find_reversed_cells(cells, FacetTable(cells));
}

Orientation find_reversed_cells(const PlainCells& cells, const FacetTable& table) {
  const std::size_t n = cells.cells.size();
  DisjointSets sets(n);
  std::vector<CellIndex> contradictions;
  table.for_each([&](NodeIndex, std::span<const CellFacet> facet) {
    if (facet.size() != 2) return;
    const bool turned = facet[0].same_direction(facet[1]);
    if (!turned && !facet[0].is_opposite(facet[1])) return;  // a face with crossing sides
    if (!sets.join(facet[0].cell, facet[1].cell, turned)) contradictions.push_back(facet[0].cell);
  });
  std::vector<PieceSums> pieces(n);
  for (CellIndex c = 0; c < n; ++c) {
    const auto [first, turned] = sets.place_of(c);
    pieces[first].size += (turned ? -1.0 : 1.0) * signed_size(cells, c);
    pieces[first].n_as_first += turned ? -1 : 1;
  }
  Orientation result;
  for (const CellIndex c : contradictions) {
    const CellIndex first = sets.first_of(c);
    pieces[first].is_one_sided = true;
    result.one_sided = std::min(first, result.one_sided.value_or(first));
  }
  for (CellIndex c = 0; c < n; ++c) {
    const auto [first, turned] = sets.place_of(c);
    const PieceSums& piece = pieces[first];
    const bool first_is_wrong = has_signs(cells) ? piece.size < 0.0 : piece.n_as_first < 0;
    if (!piece.is_one_sided && turned != first_is_wrong) result.reversed.push_back(c);
  }
  return result;
}

namespace {

/// Reverses a ring of nodes, except for its first one.
template <class Index>
void reverse_ring(std::span<Index> ring) {
  std::reverse(ring.begin() + 1, ring.end());
}

template <class Index>
void reverse(int dim, std::span<Index> nodes) {
  const std::size_t n = nodes.size();
  if (dim == 2) return reverse_ring(nodes);
  const std::size_t n_base = n == 4 || n == 6 ? 3 : 4;
  reverse_ring(nodes.first(n_base));
  if (n == 6 || n == 8) reverse_ring(nodes.subspan(n_base));  // the upper ring
}

}  // namespace

std::vector<LocalIndex> reversed_corners(int dim, std::size_t n_corners) {
  std::vector<LocalIndex> corners(n_corners);
  std::iota(corners.begin(), corners.end(), LocalIndex{0});
  reverse(dim, std::span(corners));
  return corners;
}

CompressedRows<NodeIndex> with_reversed(int dim, const CompressedRows<NodeIndex>& cells,
                                        std::span<const CellIndex> reversed) {
  CompressedRows<NodeIndex> result;
  std::vector<NodeIndex> nodes;
  for (CellIndex c = 0; c < cells.size(); ++c) {
    nodes.assign(cells[c].begin(), cells[c].end());
    if (!reversed.empty() && reversed.front() == c) {
      reverse(dim, std::span(nodes));
      reversed = reversed.subspan(1);
    }
    result.append(nodes);
  }
  return result;
}

}  // namespace smoothfem
