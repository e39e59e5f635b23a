#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "smoothing/simd/lanes.h"

namespace smoothfem {

/// The corners of n_lanes cells with n nodes each, given by their rows of nodes. place_of(node):
/// its coordinates, by reference.
template <std::size_t n, int dim, class PlaceOf>
SMOOTHFEM_INLINE std::array<Vector<dim, Lanes>, n> gather_cells(
    const PlaceOf& place_of, const std::array<const NodeIndex*, n_lanes>& rows) {
  return [&]<std::size_t... k>(std::index_sequence<k...>) SMOOTHFEM_INLINE_LAMBDA {
    return std::array<Vector<dim, Lanes>, n>{gather_corner<dim>(place_of, rows, k)...};
  }
  (std::make_index_sequence<n>{});
}

/// The corners of n_lanes neighbouring cells with n nodes each. x: of all nodes.
template <std::size_t n, int dim>
SMOOTHFEM_INLINE std::array<Vector<dim, Lanes>, n> gather_block(const Point<dim>* x,
                                                                const NodeIndex* nodes) {
  const auto place_of = [x](NodeIndex node)
                            SMOOTHFEM_INLINE_LAMBDA -> const Point<dim>& { return x[node]; };
  return gather_cells<n, dim>(place_of, {nodes, nodes + n, nodes + 2 * n, nodes + 3 * n});
}

/// Calls visit with std::integral_constant<std::size_t, n> for the number of nodes of a cell where
/// it is one of a fixed type, so that loops over them unroll; with 0 for polygons.
template <int dim, class Visit>
SMOOTHFEM_INLINE void with_cell_size(std::size_t n_nodes, const Visit& visit) {
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

/// A cell's corners, gathered: spans of fixed extent for cells of a fixed type, of dynamic extent
/// for polygons. Calls visit(corners). place_of(node): its coordinates, by reference; in space for
/// cells of surface meshes.
template <int dim, class PlaceOf, class Visit>
SMOOTHFEM_INLINE void with_corners_at(std::span<const NodeIndex> nodes, const PlaceOf& place_of,
                                      const Visit& visit) {
  using Corner = decltype(vector_of(place_of(NodeIndex{})));
  with_cell_size<dim>(nodes.size(), [&](auto size) SMOOTHFEM_INLINE_LAMBDA {
    constexpr std::size_t n = decltype(size)::value;
    if constexpr (n == 0) {
      std::vector<Corner> corners;
      corners.reserve(nodes.size());
      for (const NodeIndex node : nodes) corners.push_back(vector_of(place_of(node)));
      visit(std::span<const Corner>(corners));
    } else {
      std::array<Corner, n> corners;
      for (std::size_t k = 0; k < n; ++k) corners[k] = vector_of(place_of(nodes[k]));
      visit(std::span<const Corner, n>(corners));
    }
  });
}

/// The same with x: the coordinates of all nodes.
template <int dim, int spacedim, class Visit>
SMOOTHFEM_INLINE void with_corners(std::span<const NodeIndex> nodes,
                                   const std::vector<Point<spacedim>>& x, const Visit& visit) {
  with_corners_at<dim>(
      nodes,
      [&](NodeIndex node) SMOOTHFEM_INLINE_LAMBDA -> const Point<spacedim>& { return x[node]; },
      visit);
}

/// Room for as many points as `corners` has; calls visit(result).
template <class Point, std::size_t extent, class Visit>
SMOOTHFEM_INLINE void with_room_for_result(std::span<const Point, extent> corners,
                                           const Visit& visit) {
  if constexpr (extent == std::dynamic_extent) {
    std::vector<Point> result(corners.size());
    visit(std::span<Point>(result));
  } else {
    std::array<Point, extent> result;
    visit(std::span<Point, extent>(result));
  }
}

/// Visits the cells first .. last-1 in order: visit_run(size, cell, nodes) for n_lanes cells from
/// `cell` on where these are all of one fixed type (size: std::integral_constant of its number of
/// nodes; nodes: of all of them, cell by cell), visit_cell(cell) for the rest. Fast for meshes
/// whose types come in long runs. Cells of surface meshes (spacedim > dim), whose time goes into
/// projections, come one by one.
template <int dim, int spacedim = dim, class VisitRun, class VisitCell>
SMOOTHFEM_INLINE void for_each_run(const Topology& topology, CellIndex first, CellIndex last,
                                   const VisitRun& visit_run, const VisitCell& visit_cell) {
  if constexpr (spacedim > dim) {
    for (CellIndex c = first; c < last; ++c) visit_cell(c);
    return;
  } else {
    const auto& cells = topology.cells();
    for (CellIndex c = first; c < last;) {
      const auto nodes = cells[c];
      bool same_size = c + n_lanes <= last;
      for (std::size_t l = 1; l < n_lanes && same_size; ++l)
        same_size = cells[c + l].size() == nodes.size();
      bool done = false;
      if (same_size)
        with_cell_size<dim>(nodes.size(), [&](auto size) SMOOTHFEM_INLINE_LAMBDA {
          if constexpr (decltype(size)::value != 0) {
            visit_run(size, c, nodes.data());
            done = true;
          }
        });
      if (!done) visit_cell(c);
      c += done ? n_lanes : 1;
    }
  }
}

/// Up to n_lanes cells of one fixed type out of a list; the last one stands in for lanes behind
/// them.
struct ListedCells {
  std::size_t first, count;  ///< positions first .. first + count - 1 of the list
  std::array<CellIndex, n_lanes> cells;
  std::array<const NodeIndex*, n_lanes> rows;  ///< their nodes
};

/// Visits the cells of a list in order: visit_run(size, listed) for cells of one fixed type that
/// follow each other (size: std::integral_constant of its number of nodes), visit_cell(position)
/// for polygons and cells of surface meshes. Visitors return false to stop; returns whether all
/// were visited.
template <int dim, int spacedim = dim, class VisitRun, class VisitCell>
SMOOTHFEM_INLINE bool for_each_listed_run(const Topology& topology,
                                          std::span<const CellIndex> cells,
                                          const VisitRun& visit_run, const VisitCell& visit_cell) {
  if constexpr (spacedim > dim) {
    for (std::size_t position = 0; position < cells.size(); ++position)
      if (!visit_cell(position)) return false;
    return true;
  } else {
    for (std::size_t first = 0; first < cells.size();) {
      const std::size_t n_nodes = topology.cell_nodes(cells[first]).size();
      std::size_t count = 1;
      while (count < n_lanes && first + count < cells.size() &&
             topology.cell_nodes(cells[first + count]).size() == n_nodes)
        ++count;
      bool going = true;
      with_cell_size<dim>(n_nodes, [&](auto size) SMOOTHFEM_INLINE_LAMBDA {
        if constexpr (decltype(size)::value == 0) {
          count = 1;
          going = visit_cell(first);
        } else {
          ListedCells listed{first, count, {}, {}};
          for (std::size_t l = 0; l < n_lanes; ++l) {
            listed.cells[l] = cells[first + std::min(l, count - 1)];
            listed.rows[l] = topology.cell_nodes(listed.cells[l]).data();
          }
          going = visit_run(size, listed);
        }
      });
      if (!going) return false;
      first += count;
    }
    return true;
  }
}

/// for_each_run with the corners gathered: visit_block(cell, corners) with those of n_lanes cells,
/// visit_cell(cell, corners) with those of one.
template <int dim, int spacedim, class VisitBlock, class VisitCell>
SMOOTHFEM_INLINE void for_each_block(const Topology& topology,
                                     const std::vector<Point<spacedim>>& coordinates,
                                     CellIndex first, CellIndex last, const VisitBlock& visit_block,
                                     const VisitCell& visit_cell) {
  for_each_run<dim, spacedim>(
      topology, first, last,
      [&]<std::size_t n>(std::integral_constant<std::size_t, n>, CellIndex c,
                         const NodeIndex* nodes) SMOOTHFEM_INLINE_LAMBDA {
        visit_block(c, gather_block<n, dim>(coordinates.data(), nodes));
      },
      [&](CellIndex c) SMOOTHFEM_INLINE_LAMBDA {
        with_corners<dim>(topology.cell_nodes(c), coordinates,
                          [&](auto corners) SMOOTHFEM_INLINE_LAMBDA { visit_cell(c, corners); });
      });
}

/// The same for all cells of a mesh.
template <int dim, class VisitBlock, class VisitCell>
SMOOTHFEM_INLINE void for_each_block(const Topology& topology,
                                     const std::vector<Point<dim>>& coordinates,
                                     const VisitBlock& visit_block, const VisitCell& visit_cell) {
  for_each_block<dim>(topology, coordinates, 0, static_cast<CellIndex>(topology.n_cells()),
                      visit_block, visit_cell);
}

}  // namespace smoothfem
