// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/laplacian/cells_around_nodes.h"

#include <algorithm>
#include <utility>

#include "smoothing/base/parallel.h"

namespace smoothfem {

void CellsAroundNodes::prepare(std::shared_ptr<const Topology> topology) {
  if (topology == topology_) return;
  topology_ = std::move(topology);
  rows_ = {};
  const auto& cells = topology_->cells();
  const auto& free_nodes = topology_->free_nodes();
  std::vector<std::size_t> n_entries(topology_->n_nodes(), 0);
  for (CellIndex c = 0; c < cells.size(); ++c)
    for (const NodeIndex node : cells[c]) n_entries[node] += cells[c].size();
  first_rows_.assign(1, 0);
  std::vector<std::size_t> first_entries{0};
  for (const NodeIndex node : free_nodes) {
    first_rows_.push_back(first_rows_.back() +
                          static_cast<RowOffset>(topology_->node_cells(node).size()));
    first_entries.push_back(first_entries.back() + n_entries[node]);
  }
  if (first_entries.back() > max_entries_) return;
  std::vector<RowOffset> offsets(first_rows_.back() + 1, 0);
  std::vector<NodeIndex> entries(first_entries.back());
  constexpr std::size_t grain = 1024;
  parallel_for_ranges(free_nodes.size(), grain, [&](std::size_t first, std::size_t last) {
    std::size_t row = first_rows_[first], entry = first_entries[first];
    for (std::size_t i = first; i < last; ++i)
      for (const CellIndex c : topology_->node_cells(free_nodes[i])) {
        for (const NodeIndex node : cells[c]) entries[entry++] = node;
        offsets[++row] = static_cast<RowOffset>(entry);
      }
  });
  rows_ = {std::move(offsets), std::move(entries)};
}

}  // namespace smoothfem
