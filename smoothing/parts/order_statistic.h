// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "smoothing/mesh/topology.h"
#include "smoothing/parts/whole_mesh.h"

namespace smoothfem {

/// Returns the value at a position of the ascending values, one of each cell of the whole mesh.
/// values: of the cells here, not negative. position: below their number in the whole mesh.
/// Collective.
inline double order_statistic(const Topology& topology, const std::vector<double>& values,
                              std::size_t position) {
  const WholeMesh whole(topology);
  std::vector<double> own;
  for (CellIndex c = 0; c < topology.n_cells(); ++c)
    if (whole.owns_cell(c)) own.push_back(values[c]);
  if (topology.part() == nullptr) {
    const auto place = own.begin() + static_cast<std::ptrdiff_t>(position);
    std::nth_element(own.begin(), place, own.end());
    return *place;
  }
  // Numbers that are not negative have the order of their bits.
  std::sort(own.begin(), own.end());
  std::uint64_t low = 0,
                high = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::infinity());
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    const auto end = std::upper_bound(own.begin(), own.end(), std::bit_cast<double>(middle));
    if (topology.part()->sum(static_cast<std::size_t>(end - own.begin())) > position)
      high = middle;
    else
      low = middle + 1;
  }
  return std::bit_cast<double>(low);
}

}  // namespace smoothfem
