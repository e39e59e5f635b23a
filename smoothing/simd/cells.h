// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "smoothing/mesh/topology.h"
#include "smoothing/simd/vectors.h"

/// Groups cells of a mesh, so that loops process several cells at a time in vector registers.
/// Compile these loops with all calls inlined (flatten); otherwise formulas do not profit.

namespace smoothfem {

/// Returns the k-th corners of n_lanes cells, given by their nodes. coordinates_of(node): by
/// reference.
template <int dim, class CoordinatesOf>
inline Vector<dim, Lanes> gather_corner(const CoordinatesOf& coordinates_of,
                                        const std::array<const NodeIndex*, n_lanes>& nodes,
                                        std::size_t k) {
  const Point<dim>&a = coordinates_of(nodes[0][k]), &b = coordinates_of(nodes[1][k]),
        &c = coordinates_of(nodes[2][k]), &d = coordinates_of(nodes[3][k]);
  if constexpr (dim == 2)
    return {Lanes{a.x(), b.x(), c.x(), d.x()}, Lanes{a.y(), b.y(), c.y(), d.y()}};
  else
    return {Lanes{a.x(), b.x(), c.x(), d.x()}, Lanes{a.y(), b.y(), c.y(), d.y()},
            Lanes{a.z(), b.z(), c.z(), d.z()}};
}

/// Returns the function that returns a node's coordinates, by reference.
template <class Point>
inline auto coordinates_at(const Point* x) {
  return [x](NodeIndex node) -> const Point& { return x[node]; };
}

/// Up to n_lanes cells of one type with n nodes each, one in each lane. If there are fewer, the
/// last cell fills the lanes from `count` on.
template <std::size_t n>
struct CellBatch {
  std::size_t first;                            ///< position of the first one in its list
  std::size_t count;                            ///< 1 .. n_lanes
  std::array<CellIndex, n_lanes> cells;         ///< their numbers
  std::array<const NodeIndex*, n_lanes> nodes;  ///< the n nodes of each

  /// Returns their corners. coordinates_of(node): a node's coordinates, by reference.
  template <int dim, class CoordinatesOf>
  std::array<Vector<dim, Lanes>, n> corners_at(const CoordinatesOf& coordinates_of) const {
    return [&]<std::size_t... k>(std::index_sequence<k...>) {
      return std::array<Vector<dim, Lanes>, n>{gather_corner<dim>(coordinates_of, nodes, k)...};
    }
    (std::make_index_sequence<n>{});
  }
  /// Returns their corners from the coordinates of all nodes.
  template <int dim>
  std::array<Vector<dim, Lanes>, n> corners(const Point<dim>* x) const {
    return corners_at<dim>(coordinates_at(x));
  }

  /// Calls visit(l) for the lanes in use, in their order.
  template <class Visit>
  void for_each_lane(const Visit& visit) const {
    if (count == n_lanes)
      unrolled<n_lanes>([&](auto l) { visit(std::size_t{l}); });
    else
      for (std::size_t l = 0; l < count; ++l) visit(l);
  }

  /// Writes a number for each cell to its position in `numbers`.
  void store(Lanes values, double* numbers) const {
    if (count == n_lanes)
      store_lanes(values, numbers + first);
    else
      for (std::size_t l = 0; l < count; ++l) numbers[first + l] = values[l];
  }
};

/// Prefetches the corners of some cells, all at once. If they lie far apart in memory, formulas
/// that go from cell to cell would wait for each of them. x: coordinates of all nodes. (GCC removes
/// calls of a function that only prefetches, unless it is inlined early.)
template <int spacedim>
[[gnu::always_inline]] inline void prefetch_corners(const Topology& topology,
                                                    std::span<const CellIndex> cells,
                                                    const Point<spacedim>* x) {
  constexpr std::size_t fits_cache = 16384;  // nodes
  if (topology.n_nodes() < fits_cache) return;
  for (const CellIndex c : cells) __builtin_prefetch(topology.cell_nodes(c).data());
  for (const CellIndex c : cells)
    for (const NodeIndex node : topology.cell_nodes(c)) __builtin_prefetch(&x[node]);
}

/// Calls visit with std::integral_constant<std::size_t, n> for the number n of nodes of a cell of a
/// fixed type, so that loops over them unroll. Calls it with 0 for polygons.
template <int dim, class Visit>
inline void with_cell_size(std::size_t n_nodes, const Visit& visit) {
  if constexpr (dim == 2) {
    if (n_nodes == 3)
      visit(std::integral_constant<std::size_t, 3>{});
    else if (n_nodes == 4)
      visit(std::integral_constant<std::size_t, 4>{});
    else
      visit(std::integral_constant<std::size_t, 0>{});
  } else {
    if (n_nodes == 4)
      visit(std::integral_constant<std::size_t, 4>{});
    else if (n_nodes == 8)
      visit(std::integral_constant<std::size_t, 8>{});
    else if (n_nodes == 5)
      visit(std::integral_constant<std::size_t, 5>{});
    else
      visit(std::integral_constant<std::size_t, 6>{});
  }
}

/// Calls visit(corners) with the corners of one cell: a span of fixed extent for cells of a fixed
/// type, of dynamic extent for polygons. Points are in space for cells of surface meshes.
/// coordinates_of(node): by reference.
template <int dim, class CoordinatesOf, class Visit>
inline void with_corners_at(std::span<const NodeIndex> nodes, const CoordinatesOf& coordinates_of,
                            const Visit& visit) {
  using Corner = decltype(vector_of(coordinates_of(NodeIndex{})));
  with_cell_size<dim>(nodes.size(), [&](auto size) {
    constexpr std::size_t n = decltype(size)::value;
    if constexpr (dim == 2) {  // clang compiles the following lines for every n
      if constexpr (n == 0) {
        std::vector<Corner> corners;
        corners.reserve(nodes.size());
        for (const NodeIndex node : nodes) corners.push_back(vector_of(coordinates_of(node)));
        visit(std::span<const Corner>(corners));
      }
    }
    if constexpr (n > 0) {
      std::array<Corner, n> corners;
      for (std::size_t k = 0; k < n; ++k) corners[k] = vector_of(coordinates_of(nodes[k]));
      visit(std::span<const Corner, n>(corners));
    }
  });
}

/// Calls visit(corners) with corners from the coordinates of all nodes.
template <int dim, int spacedim, class Visit>
inline void with_corners(std::span<const NodeIndex> nodes, const Point<spacedim>* x,
                         const Visit& visit) {
  with_corners_at<dim>(nodes, coordinates_at(x), visit);
}

/// Calls visit(corners) with the corners of a planar polygon of any number of nodes.
template <class Visit>
inline void with_polygon(std::span<const NodeIndex> nodes, const Point<2>* x, const Visit& visit) {
  std::vector<Vector2<double>> corners;
  corners.reserve(nodes.size());
  for (const NodeIndex node : nodes) corners.push_back(vector_of(x[node]));
  visit(std::span<const Vector2<double>>(corners));
}

/// Calls visit(result) with as many points as `corners` has, to be set.
template <class Point, std::size_t extent, class Visit>
inline void with_result(std::span<const Point, extent> corners, const Visit& visit) {
  if constexpr (extent == std::dynamic_extent) {
    std::vector<Point> result(corners.size());
    visit(std::span<Point>(result));
  } else {
    std::array<Point, extent> result;
    visit(std::span<Point, extent>(result));
  }
}

/// True if cells of meshes of these dimensions come in batches. Cells of surface meshes come one by
/// one, as most of their time goes into projections.
template <int dim, int spacedim>
inline constexpr bool comes_in_batches = dim == spacedim;

/// Visits the cells first .. last-1 in order. Calls visit_batch(batch) for n_lanes consecutive
/// cells of one fixed type, or for a single one. Calls visit_cell(cell) for polygons and cells of
/// surface meshes. Fast for meshes whose types come in long runs.
template <int dim, int spacedim = dim, class VisitBatch, class VisitCell>
[[gnu::flatten]] void for_each_batch(const Topology& topology, CellIndex first, CellIndex last,
                                     const VisitBatch& visit_batch, const VisitCell& visit_cell) {
  if constexpr (!comes_in_batches<dim, spacedim>) {
    for (CellIndex c = first; c < last; ++c) visit_cell(c);
  } else {
    const auto& cells = topology.cells();
    for (CellIndex c = first; c < last;) {
      const auto nodes = cells[c];
      bool same_size = c + n_lanes <= last;
      for (std::size_t l = 1; l < n_lanes && same_size; ++l)
        same_size = cells[c + l].size() == nodes.size();
      std::size_t count = same_size ? n_lanes : 1;
      with_cell_size<dim>(nodes.size(), [&](auto size) {
        constexpr std::size_t n = decltype(size)::value;
        if constexpr (n == 0) {
          count = 1;
          visit_cell(c);
        } else {
          const CellIndex step = same_size ? 1 : 0;
          const NodeIndex* const row = nodes.data();
          visit_batch(CellBatch<n>{c,
                                   count,
                                   {c, c + step, c + 2 * step, c + 3 * step},
                                   {row, row + n * step, row + 2 * n * step, row + 3 * n * step}});
        }
      });
      c += static_cast<CellIndex>(count);
    }
  }
}

/// Cells of a list: their numbers and their nodes.
class ListedCells {
 public:
  ListedCells(const Topology& topology, std::span<const CellIndex> cells)
      : topology_(topology), cells_(cells) {}

  std::size_t size() const { return cells_.size(); }
  CellIndex number(std::size_t position) const { return cells_[position]; }
  std::span<const NodeIndex> nodes(std::size_t position) const {
    return topology_.cell_nodes(cells_[position]);
  }

 private:
  const Topology& topology_;
  std::span<const CellIndex> cells_;
};

/// Visits some cells (ListedCells or a class with its functions) in order. Calls visit_batch(batch)
/// for up to n_lanes consecutive cells of one fixed type. Calls visit_cell(position) for polygons
/// and cells of surface meshes. Visitors return false to stop. Returns true if all cells were
/// visited.
template <int dim, int spacedim = dim, class Cells, class VisitBatch, class VisitCell>
[[gnu::flatten]] bool for_each_batch(const Cells& cells, const VisitBatch& visit_batch,
                                     const VisitCell& visit_cell) {
  if constexpr (!comes_in_batches<dim, spacedim>) {
    for (std::size_t position = 0; position < cells.size(); ++position)
      if (!visit_cell(position)) return false;
  } else {
    for (std::size_t first = 0; first < cells.size();) {
      const std::size_t n_nodes = cells.nodes(first).size();
      std::size_t count = 1;
      while (count < n_lanes && first + count < cells.size() &&
             cells.nodes(first + count).size() == n_nodes)
        ++count;
      bool keep_going = true;
      with_cell_size<dim>(n_nodes, [&](auto size) {
        constexpr std::size_t n = decltype(size)::value;
        if constexpr (n == 0) {
          count = 1;
          keep_going = visit_cell(first);
        } else {
          CellBatch<n> batch{first, count, {}, {}};
          for (std::size_t l = 0; l < n_lanes; ++l) {
            const std::size_t position = first + std::min(l, count - 1);
            batch.cells[l] = cells.number(position);
            batch.nodes[l] = cells.nodes(position).data();
          }
          keep_going = visit_batch(batch);
        }
      });
      if (!keep_going) return false;
      first += count;
    }
  }
  return true;
}

}  // namespace smoothfem
