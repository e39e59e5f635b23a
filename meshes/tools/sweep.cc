// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/sweep.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace smoothfem {

VolumeCells sweep(const PlanarCells& base, const std::vector<double>& heights,
                  const std::function<std::size_t(CellIndex)>& n_layers) {
  const auto n_cells = static_cast<CellIndex>(base.cells.size());
  // A node exists up to the top of its highest column.
  std::vector<std::size_t> top(base.coordinates.size(), 0);
  for (CellIndex c = 0; c < n_cells; ++c) {
    assert(base.cells[c].size() == 4 && n_layers(c) >= 1 && n_layers(c) < heights.size());
    for (const NodeIndex node : base.cells[c]) top[node] = std::max(top[node], n_layers(c));
  }
  VolumeCells swept;
  std::vector<NodeIndex> below(base.coordinates.size()), above(base.coordinates.size());
  for (std::size_t level = 0; level < heights.size(); ++level) {
    for (std::size_t i = 0; i < top.size(); ++i) {
      if (top[i] < level) continue;
      above[i] = static_cast<NodeIndex>(swept.coordinates.size());
      swept.coordinates.emplace_back(base.coordinates[i].x(), base.coordinates[i].y(),
                                     heights[level]);
    }
    for (CellIndex c = 0; level > 0 && c < n_cells; ++c) {
      if (n_layers(c) < level) continue;
      const auto q = base.cells[c];
      swept.cells.append(std::array<NodeIndex, 8>{below[q[0]], below[q[1]], below[q[2]],
                                                  below[q[3]], above[q[0]], above[q[1]],
                                                  above[q[2]], above[q[3]]});
    }
    std::swap(below, above);
  }
  return swept;
}

std::vector<double> equal_layers(double height, double n_layers) {
  const long n = std::max(1L, std::lround(n_layers));
  std::vector<double> heights;
  for (long i = 0; i <= n; ++i)
    heights.push_back(height * static_cast<double>(i) / static_cast<double>(n));
  return heights;
}

VolumeCells sweep(const PlanarCells& base, const std::vector<double>& heights) {
  return sweep(base, heights, [&](CellIndex) { return heights.size() - 1; });
}

}  // namespace smoothfem
