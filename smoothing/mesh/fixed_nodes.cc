// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/mesh/fixed_nodes.h"

#include <algorithm>
#include <set>
#include <sstream>

namespace smoothfem {

FixedNodesRule parse_fixed_nodes_rule(const std::string& text) {
  using Kind = FixedNodesRule::Kind;
  constexpr std::string_view group = "group=";
  if (text == "boundary") return {Kind::boundary, {}};
  if (text == "file") return {Kind::file, {}};
  if (text == "free") return {Kind::none, {}};
  FixedNodesRule rule{Kind::groups, {}};
  if (text.starts_with(group)) {
    std::istringstream names(text.substr(group.size()));
    for (std::string name; std::getline(names, name, ',');)
      if (!name.empty()) rule.groups.push_back(name);
  }
  if (rule.groups.empty())
    throw InputError("the rule for fixed nodes is '" + text +
                     "'; use boundary, file, free or group=NAME[,NAME...]");
  return rule;
}

namespace {

std::string name_of_tag(const Topology& topology, int tag) {
  const auto& names = topology.labels().names;
  const auto found = names.find({topology.dimension() - 1, tag});
  return found == names.end() ? std::string() : found->second;
}

/// Returns the list of groups for an error message, for example "4, 5 (inlet)".
std::string available_groups(const Topology& topology, const std::set<int>& tags) {
  if (tags.empty()) return "the mesh has no labelled boundary groups";
  std::string text = "the mesh has the groups ";
  for (const int tag : tags) {
    const std::string name = name_of_tag(topology, tag);
    text += (tag == *tags.begin() ? "" : ", ") + std::to_string(tag) +
            (name.empty() ? "" : " (" + name + ")");
  }
  return text;
}

std::vector<bool> nodes_of_groups(const Topology& topology,
                                  const std::vector<std::string>& groups) {
  const MeshLabels& labels = topology.labels();
  const std::set<int> tags(labels.facet_tags.begin(), labels.facet_tags.end());
  std::set<int> wanted;
  for (const std::string& group : groups) {
    const auto matches = [&](int tag) {
      return group == std::to_string(tag) || group == name_of_tag(topology, tag);
    };
    const auto tag = std::find_if(tags.begin(), tags.end(), matches);
    if (tag == tags.end())
      throw InputError("no boundary group is called '" + group + "'; " +
                       available_groups(topology, tags));
    wanted.insert(*tag);
  }
  std::vector<bool> fixed(topology.n_nodes(), false);
  for (std::size_t f = 0; f < labels.facets.size(); ++f)
    if (wanted.contains(labels.facet_tags[f]))
      for (const NodeIndex node : labels.facets[f]) fixed[node] = true;
  return fixed;
}

}  // namespace

std::vector<bool> fixed_nodes(const Topology& topology, const FixedNodesRule& rule) {
  std::vector<bool> fixed(topology.n_nodes(), false);
  switch (rule.kind) {
    case FixedNodesRule::Kind::boundary:
      fixed = topology.on_boundary();
      break;
    case FixedNodesRule::Kind::file:
      for (NodeIndex i = 0; i < topology.n_nodes(); ++i) fixed[i] = topology.is_fixed(i);
      break;
    case FixedNodesRule::Kind::groups:
      fixed = nodes_of_groups(topology, rule.groups);
      break;
    case FixedNodesRule::Kind::none:
      break;
  }
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
    if (topology.node_cells(i).empty()) fixed[i] = true;
  return fixed;
}

}  // namespace smoothfem
