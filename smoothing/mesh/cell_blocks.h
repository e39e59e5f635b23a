#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "smoothing/mesh/lanes.h"

namespace smoothfem {

/// A cell's corners, gathered: spans of fixed extent for triangles and quadrilaterals (so that
/// loops over them unroll), of dynamic extent for polygons. Calls visit(corners). x: of all nodes.
template <class Visit>
SMOOTHFEM_INLINE void with_corners(std::span<const NodeIndex> nodes, const std::vector<Point<2>>& x,
                                   const Visit& visit) {
  if (nodes.size() == 3) {
    const std::array corners{vector_of(x[nodes[0]]), vector_of(x[nodes[1]]),
                             vector_of(x[nodes[2]])};
    visit(std::span<const Vector2<double>, 3>(corners));
  } else if (nodes.size() == 4) {
    const std::array corners{vector_of(x[nodes[0]]), vector_of(x[nodes[1]]), vector_of(x[nodes[2]]),
                             vector_of(x[nodes[3]])};
    visit(std::span<const Vector2<double>, 4>(corners));
  } else {
    std::vector<Vector2<double>> corners;
    corners.reserve(nodes.size());
    for (const NodeIndex node : nodes) corners.push_back(vector_of(x[node]));
    visit(std::span<const Vector2<double>>(corners));
  }
}

/// Room for as many points as `corners` has; calls visit(result).
template <std::size_t extent, class Visit>
SMOOTHFEM_INLINE void with_room_for_result(std::span<const Vector2<double>, extent> corners,
                                           const Visit& visit) {
  if constexpr (extent == std::dynamic_extent) {
    std::vector<Vector2<double>> result(corners.size());
    visit(std::span<Vector2<double>>(result));
  } else {
    std::array<Vector2<double>, extent> result;
    visit(std::span<Vector2<double>, extent>(result));
  }
}

/// The corners of n_lanes cells with n nodes each, given by their rows of nodes.
template <std::size_t n>
SMOOTHFEM_INLINE std::array<Vector2<Lanes>, n> gather_cells(
    const Point<2>* x, const std::array<const NodeIndex*, n_lanes>& rows) {
  if constexpr (n == 3)
    return {gather_corner(x, rows, 0), gather_corner(x, rows, 1), gather_corner(x, rows, 2)};
  else
    return {gather_corner(x, rows, 0), gather_corner(x, rows, 1), gather_corner(x, rows, 2),
            gather_corner(x, rows, 3)};
}

/// The corners of n_lanes neighbouring cells with n nodes each.
template <std::size_t n>
SMOOTHFEM_INLINE std::array<Vector2<Lanes>, n> gather_block(const Point<2>* x,
                                                            const NodeIndex* nodes) {
  return gather_cells<n>(x, {nodes, nodes + n, nodes + 2 * n, nodes + 3 * n});
}

/// Visits all cells in order: visit_block(cell, corners) with the corners of the n_lanes cells from
/// `cell` on where these are all triangles or all quadrilaterals, visit_cell(cell, corners) for the
/// rest. Fast for meshes whose types come in long runs.
template <class VisitBlock, class VisitCell>
SMOOTHFEM_INLINE void for_each_block(const Topology& topology,
                                     const std::vector<Point<2>>& coordinates,
                                     const VisitBlock& visit_block, const VisitCell& visit_cell) {
  const auto& cells = topology.cells();
  const auto* x = coordinates.data();
  const auto same_size = [&](std::size_t first, std::size_t n) {
    if (first + n_lanes > cells.size()) return false;
    for (std::size_t l = 1; l < n_lanes; ++l)
      if (cells[first + l].size() != n) return false;
    return true;
  };
  for (CellIndex c = 0; c < cells.size();) {
    const auto nodes = cells[c];
    if (nodes.size() == 3 && same_size(c, 3)) {
      visit_block(c, gather_block<3>(x, nodes.data()));
      c += n_lanes;
    } else if (nodes.size() == 4 && same_size(c, 4)) {
      visit_block(c, gather_block<4>(x, nodes.data()));
      c += n_lanes;
    } else {
      with_corners(nodes, coordinates,
                   [&](auto corners) SMOOTHFEM_INLINE_LAMBDA { visit_cell(c, corners); });
      ++c;
    }
  }
}

}  // namespace smoothfem
