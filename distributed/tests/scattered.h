// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>

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

/// All cells of a scattered mesh, in their order, as words: number, material, corners. Materials
/// are numbered as they first appear.
template <int dim>
std::vector<GlobalIndex> all_cells(const Ranks& ranks, const ScatteredMesh<dim>& mesh) {
  std::vector<std::vector<GlobalIndex>> to(static_cast<std::size_t>(ranks.size()));
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) append_words(mesh.cells, c, to[0]);
  CellTable cells = sorted_cells(ranks.exchange(std::move(to)), 0);
  std::map<int, int> numbers;
  for (int& material : cells.materials)
    material = numbers.try_emplace(material, static_cast<int>(numbers.size())).first->second;
  std::vector<GlobalIndex> words;
  for (std::size_t c = 0; c < cells.size(); ++c) append_words(cells, c, words);
  return words;
}

}  // namespace smoothfem
