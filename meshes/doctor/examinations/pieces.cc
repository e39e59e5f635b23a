// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/doctor/examinations/pieces.h"

#include <algorithm>

#include "meshes/doctor/examinations/disjoint_sets.h"
#include "smoothing/mesh/volume_elements.h"

namespace smoothfem {

namespace {

/// Returns flags of the nodes of boundary facets with a hanging or coincident node.
std::vector<bool> on_seams(const PlainCells& cells, const Skin& skin,
                           const std::vector<HangingNode>& hanging,
                           const CoincidentNodes& coincident) {
  auto flags = seam_flags(cells, skin, hanging, coincident);
  if (hanging.empty() && coincident.count == 0) return flags;
  std::vector<bool> is_odd(flags.size(), false);
  for (const auto& [node, facet] : hanging) is_odd[node] = true;
  for (NodeIndex i = 0; i < coincident.first.size(); ++i)
    if (!coincident.is_first(i)) is_odd[i] = is_odd[coincident.first[i]] = true;
  for (std::size_t f = 0; f < skin.facets.size(); ++f) {
    const auto facet = skin.facets[f];
    if (std::none_of(facet.begin(), facet.end(), [&](NodeIndex i) { return is_odd[i]; })) continue;
    for (const NodeIndex i : facet) flags[i] = true;
  }
  return flags;
}

/// Counts the groups of cells, or of boundary facets, around a node that have no edge at the node
/// in common.
class GroupsAround {
 public:
  GroupsAround(int dim, const CompressedRows<NodeIndex>& rows, std::size_t n_nodes)
      : dim_(dim), rows_(rows), around_(rows_by_entry(rows, n_nodes)) {}

  std::size_t count(NodeIndex node) {
    const auto around = around_[node];
    ends_.clear();
    for (std::uint32_t k = 0; k < around.size(); ++k) {
      const auto nodes = rows_[around[k]];
      for_each_edge(dim_, nodes.size(), [&](std::size_t a, std::size_t b) {
        if (nodes[a] == node) ends_.emplace_back(nodes[b], k);
        if (nodes[b] == node) ends_.emplace_back(nodes[a], k);
      });
    }
    std::sort(ends_.begin(), ends_.end());
    DisjointSets groups(around.size());
    for (std::size_t e = 1; e < ends_.size(); ++e)
      if (ends_[e].first == ends_[e - 1].first) groups.join(ends_[e].second, ends_[e - 1].second);
    std::size_t n = 0;
    for (std::uint32_t k = 0; k < around.size(); ++k) n += groups.first_of(k) == k;
    return n;
  }

 private:
  int dim_;
  const CompressedRows<NodeIndex>& rows_;
  CompressedRows<std::uint32_t> around_;
  std::vector<std::pair<NodeIndex, std::uint32_t>> ends_;  ///< other end of an edge, its row
};

/// Returns the nodes where pieces may touch: few, unless the mesh is a surface.
std::vector<NodeIndex> candidates(const PlainCells& cells, const Skin& skin) {
  const std::size_t n_nodes = cells.points.size();
  std::vector<NodeIndex> nodes;
  if (cells.dim == 3) {
    GroupsAround facets(2, skin.facets, n_nodes);
    for (const NodeIndex i : skin.nodes)
      if (facets.count(i) > 1) nodes.push_back(i);
    return nodes;
  }
  std::vector<std::uint8_t> n_edges(n_nodes, 0);
  for (const NodeIndex i : skin.facets.entries())
    if (n_edges[i] < 3) ++n_edges[i];
  // Two cones of a closed surface may touch with their tips, which are not on its boundary.
  for (NodeIndex i = 0; i < n_nodes; ++i)
    if (n_edges[i] > 2 || !cells.planar) nodes.push_back(i);
  return nodes;
}

}  // namespace

std::size_t count_pieces(const PlainCells& cells) {
  DisjointSets sets(cells.points.size());
  std::vector<bool> used(cells.points.size(), false);
  for (CellIndex c = 0; c < cells.cells.size(); ++c)
    for (const NodeIndex node : cells.cells[c]) {
      sets.join(cells.cells[c][0], node);
      used[node] = true;
    }
  std::size_t n = 0;
  for (NodeIndex i = 0; i < cells.points.size(); ++i) n += used[i] && sets.first_of(i) == i;
  return n;
}

std::vector<NodeIndex> find_touching_nodes(const PlainCells& cells, const Skin& skin,
                                           const std::vector<HangingNode>& hanging,
                                           const CoincidentNodes& coincident) {
  auto nodes = candidates(cells, skin);
  if (nodes.empty()) return nodes;
  const auto on_seam = on_seams(cells, skin, hanging, coincident);
  GroupsAround groups(cells.dim, cells.cells, cells.points.size());
  std::erase_if(nodes, [&](NodeIndex i) { return on_seam[i] || groups.count(i) < 2; });
  return nodes;
}

std::vector<std::array<NodeIndex, 2>> find_touching_edges(const PlainCells& cells, const Skin& skin,
                                                          const std::vector<HangingNode>& hanging,
                                                          const CoincidentNodes& coincident) {
  if (cells.dim == 2) return {};
  const auto on_seam = on_seams(cells, skin, hanging, coincident);
  std::vector<std::array<NodeIndex, 2>> edges, found;
  for (std::size_t f = 0; f < skin.facets.size(); ++f) {
    const auto nodes = skin.facets[f];
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const NodeIndex a = nodes[k], b = nodes[(k + 1) % nodes.size()];
      if (!on_seam[a] || !on_seam[b]) edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
    while (last < edges.size() && edges[last] == edges[first]) ++last;
    if (last - first > 3) found.push_back(edges[first]);
  }
  return found;
}

}  // namespace smoothfem
