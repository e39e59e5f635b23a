#pragma once

#include <algorithm>
#include <span>

#include "smoothing/mesh/cell_blocks.h"
#include "smoothing/quality/mean_ratio.h"

namespace smoothfem {

/// Mean ratios of some cells, in their order: visit(position, quality) for each, false to stop.
/// Takes cells of one type several at a time where they follow each other. place_of(node): its
/// coordinates, by reference. Returns whether all were visited.
template <int dim, class PlaceOf, class Visit>
SMOOTHFEM_INLINE bool for_each_mean_ratio(const Topology& topology,
                                          std::span<const CellIndex> cells, const PlaceOf& place_of,
                                          const Visit& visit) {
  for (std::size_t first = 0; first < cells.size();) {
    const std::size_t n_nodes = topology.cell_nodes(cells[first]).size();
    std::size_t count = 1;
    while (count < n_lanes && first + count < cells.size() &&
           topology.cell_nodes(cells[first + count]).size() == n_nodes)
      ++count;
    bool going = true;
    with_cell_size<dim>(n_nodes, [&](auto size) SMOOTHFEM_INLINE_LAMBDA {
      constexpr std::size_t n = decltype(size)::value;
      if constexpr (n == 0) {
        count = 1;
        with_corners_at<dim>(topology.cell_nodes(cells[first]), place_of,
                             [&](auto corners) { going = visit(first, mean_ratio(corners)); });
      } else {
        std::array<const NodeIndex*, n_lanes> rows;
        for (std::size_t l = 0; l < n_lanes; ++l)
          rows[l] = topology.cell_nodes(cells[first + std::min(l, count - 1)]).data();
        const auto corners = gather_cells<n, dim>(place_of, rows);
        const Lanes quality = mean_ratio(std::span<const Vector<dim, Lanes>, n>(corners));
        for (std::size_t l = 0; l < count && going; ++l) going = visit(first + l, quality[l]);
      }
    });
    if (!going) return false;
    first += count;
  }
  return true;
}

}  // namespace smoothfem
