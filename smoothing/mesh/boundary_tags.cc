// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/mesh/boundary_tags.h"

#include <algorithm>
#include <map>

namespace smoothfem {

namespace {

std::vector<NodeIndex> sorted(std::span<const NodeIndex> nodes) {
  std::vector<NodeIndex> result(nodes.begin(), nodes.end());
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace

std::vector<int> boundary_tags(const Topology& topology) {
  const MeshLabels& labels = topology.labels();
  if (labels.facets.empty()) return {};
  std::map<std::vector<NodeIndex>, int> tags;
  for (std::size_t f = 0; f < labels.facets.size(); ++f)
    tags[sorted(labels.facets[f])] = labels.facet_tags[f];
  std::vector<int> result;
  for (std::size_t f = 0; f < topology.boundary_facets().size(); ++f) {
    const auto found = tags.find(sorted(topology.boundary_facets()[f]));
    result.push_back(found == tags.end() ? 0 : found->second);
  }
  return result;
}

}  // namespace smoothfem
