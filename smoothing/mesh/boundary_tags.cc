// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/mesh/boundary_tags.h"

#include <map>
#include <set>

#include "smoothing/mesh/sorted_nodes.h"

namespace smoothfem {

std::vector<int> boundary_tags(const Topology& topology) {
  const MeshLabels& labels = topology.labels();
  if (labels.facets.empty()) return {};
  std::map<std::vector<NodeIndex>, int> tags;
  for (std::size_t f = 0; f < labels.facets.size(); ++f)
    tags[sorted_nodes(labels.facets[f])] = labels.facet_tags[f];
  std::vector<int> result;
  for (std::size_t f = 0; f < topology.boundary_facets().size(); ++f) {
    const auto found = tags.find(sorted_nodes(topology.boundary_facets()[f]));
    result.push_back(found == tags.end() ? 0 : found->second);
  }
  return result;
}

std::string groups_text(const std::vector<std::pair<int, std::string>>& groups) {
  if (groups.empty()) return "the mesh has no labelled boundary groups";
  std::string text;
  for (const auto& [tag, name] : groups)
    text += (text.empty() ? "the mesh has the groups " : ", ") + std::to_string(tag) +
            (name.empty() ? "" : " (" + name + ")");
  return text;
}

std::string groups_of_boundary(const MeshLabels& labels, int dimension) {
  std::vector<std::pair<int, std::string>> groups;
  for (const int tag : std::set<int>(labels.facet_tags.begin(), labels.facet_tags.end())) {
    const auto name = labels.names.find({dimension, tag});
    groups.emplace_back(tag, name == labels.names.end() ? std::string() : name->second);
  }
  return groups_text(groups);
}

}  // namespace smoothfem
