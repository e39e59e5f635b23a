// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/constraints/node_ties.h"

#include <algorithm>
#include <map>

#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

using Masters = std::map<NodeIndex, double>;

/// Replaces masters that are tied by their own masters.
class TieResolver {
 public:
  explicit TieResolver(const std::vector<NodeTie>& ties) {
    for (const auto& tie : ties) given_.emplace(tie.node, &tie);
  }

  const Masters& masters(NodeIndex node) {
    const auto known = resolved_.find(node);
    if (known != resolved_.end()) return known->second;
    if (!open_.insert(node).second)
      throw InputError("node " + std::to_string(node) +
                       " is tied to itself by hanging nodes and periodic partners, so that its "
                       "value is not determined: correct the mesh");
    Masters result;
    for (const auto& [master, weight] : given_.at(node)->masters)
      if (given_.contains(master))
        for (const auto& [further, factor] : masters(master)) result[further] += weight * factor;
      else
        result[master] += weight;
    open_.erase(node);
    return resolved_[node] = std::move(result);
  }

 private:
  std::map<NodeIndex, const NodeTie*> given_;
  std::map<NodeIndex, Masters> resolved_;
  std::set<NodeIndex> open_;
};

}  // namespace

NodeTies joined_ties(NodeTies first, const NodeTies& second) {
  std::set<NodeIndex> tied;
  for (const auto& tie : first.nodes) tied.insert(tie.node);
  for (const auto& tie : second.nodes)
    if (!tied.contains(tie.node)) first.nodes.push_back(tie);
  first.inner_facets.insert(second.inner_facets.begin(), second.inner_facets.end());
  std::sort(first.nodes.begin(), first.nodes.end(),
            [](const NodeTie& a, const NodeTie& b) { return a.node < b.node; });
  TieResolver resolver(first.nodes);
  std::vector<NodeTie> resolved;
  for (const auto& tie : first.nodes) {
    const Masters& masters = resolver.masters(tie.node);
    resolved.push_back({tie.node, {masters.begin(), masters.end()}});
  }
  first.nodes = std::move(resolved);
  return first;
}

}  // namespace smoothfem
