// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// Replaces the value of each cell by the mean over its nodes of the means over the cells around
/// each node. of_cells: numbers, vectors or tensors; zero: the zero of that type.
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
