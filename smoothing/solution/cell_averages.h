// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// Each cell gets the mean of its nodes, which have the mean of the cells around them. of_cells:
/// numbers, vectors or tensors; zero: of that type.
template <class Value>
void average_over_nodes(const Topology& topology, const Value& zero, std::vector<Value>& of_cells) {
  std::vector<Value> of_nodes(topology.n_nodes(), zero);
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i) {
    const auto cells = topology.node_cells(i);
    for (const CellIndex c : cells) of_nodes[i] += of_cells[c];
    if (!cells.empty()) of_nodes[i] /= static_cast<double>(cells.size());
  }
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const auto nodes = topology.cell_nodes(c);
    of_cells[c] = zero;
    for (const NodeIndex i : nodes) of_cells[c] += of_nodes[i];
    of_cells[c] /= static_cast<double>(nodes.size());
  }
}

}  // namespace smoothfem
