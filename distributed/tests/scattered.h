// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "distributed/scattered_mesh.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// The cells of a mesh, spread over the ranks without order.
template <int dim>
ScatteredMesh<dim> scattered(const Ranks& ranks, const Mesh<dim>& mesh) {
  ScatteredMesh<dim> result{.n_cells = mesh.n_cells(),
                            .nodes = NodeDirectory<NodeEntry<dim>>(ranks, mesh.n_nodes())};
  const auto& tags = mesh.topology().labels().cell_tags;
  const auto n_ranks = static_cast<std::size_t>(ranks.size());
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    if ((c * 7 + c / 3) % n_ranks == static_cast<std::size_t>(ranks.rank()))
      result.cells.append(c, tags.empty() ? 0 : tags[c], mesh.topology().cell_nodes(c));
  std::vector<GlobalIndex> numbers;
  std::vector<NodeEntry<dim>> entries;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    numbers.push_back(i);
    entries.push_back(node_entry<dim>(mesh.coordinates()[i], 0));
  }
  result.nodes.give(numbers, entries,
                    [](NodeEntry<dim>& kept, const NodeEntry<dim>& node, int) { kept = node; });
  return result;
}

}  // namespace smoothfem
