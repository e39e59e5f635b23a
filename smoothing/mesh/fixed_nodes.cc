// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/mesh/fixed_nodes.h"

#include <algorithm>
#include <set>
#include <span>
#include <sstream>
#include <tuple>

#include "smoothing/mesh/boundary_tags.h"
#include "smoothing/mesh/interfaces.h"
#include "smoothing/parts/mesh_part.h"

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

/// A physical group of elements below the cells' dimension.
struct Group {
  int dimension, tag;
  std::string name;

  bool operator<(const Group& other) const {
    return std::tie(tag, dimension) < std::tie(other.tag, other.dimension);
  }
};

/// Calls use(group, nodes) for each element below the cells' dimension and each of its groups.
template <class Use>
void for_each_group_member(const Topology& topology, const Use& use) {
  const MeshLabels& labels = topology.labels();
  const FileContent* content = labels.content.get();
  const auto visit = [&](int dimension, const CompressedRows<NodeIndex>& rows,
                         const std::vector<int>& tags, const std::vector<int>& entities) {
    for (std::size_t e = 0; e < tags.size(); ++e)
      for (const int tag :
           groups_of(content, dimension, entities.empty() ? 0 : entities[e], tags[e])) {
        const auto name = labels.names.find({dimension, tag});
        use(Group{dimension, tag, name == labels.names.end() ? std::string() : name->second},
            rows[e]);
      }
  };
  visit(topology.dimension() - 1, labels.facets, labels.facet_tags,
        content ? content->facet_entities : std::vector<int>());
  for (int d = topology.dimension() - 1; content && d >= 0; --d)
    visit(d, content->others[d].nodes, content->others[d].tags, content->others[d].entities);
}

/// Returns the list of groups for an error message, for example "4, 5 (inlet)".
std::string available_groups(const std::set<Group>& groups) {
  std::vector<std::pair<int, std::string>> listed;
  for (const Group& group : groups) listed.emplace_back(group.tag, group.name);
  return groups_text(listed);
}

void add_groups(const Topology& topology, const std::vector<std::string>& names,
                std::vector<FixedReasons>& reasons) {
  std::set<Group> groups;
  std::set<std::string> missing(names.begin(), names.end());
  for_each_group_member(topology, [&](Group group, std::span<const NodeIndex> nodes) {
    bool is_wanted = false;
    for (const std::string& name : names)
      if (name == std::to_string(group.tag) || name == group.name) {
        is_wanted = true;
        missing.erase(name);
      }
    if (is_wanted)
      for (const NodeIndex node : nodes) reasons[node] |= bit(FixedReason::marked);
    groups.insert(std::move(group));
  });
  for (const std::string& name : names)
    if (missing.contains(name))
      throw InputError("no boundary group is called '" + name + "'; " + available_groups(groups));
}

/// Words after a number of nodes in fixed_reasons_text(), in the order of fixed_reasons.
constexpr std::array<const char*, fixed_reasons.size()> reason_texts{
    "on the boundary",
    "marked as fixed",
    "on interfaces between groups",
    "required by the file",
    "on seams of hanging or coincident nodes",
    "in layers",
    "with periodic partners",
    "on corners",
    "without a cell"};

}  // namespace

std::vector<FixedReasons> without(const std::vector<FixedReasons>& reasons, FixedReasons removed) {
  auto result = reasons;
  for (FixedReasons& of_node : result) of_node &= static_cast<FixedReasons>(~removed);
  return result;
}

std::vector<FixedReasons> fixed_nodes(const Topology& topology, const FixedNodesRule& rule) {
  constexpr FixedReasons by_rule = bit(FixedReason::boundary) | bit(FixedReason::marked),
                         by_file = by_rule | bit(FixedReason::required);
  using Kind = FixedNodesRule::Kind;
  if (rule.kind == Kind::file) return topology.fixed_reasons();
  if (rule.kind == Kind::none) return without(topology.fixed_reasons(), by_file);
  if (rule.kind == Kind::groups) {
    auto reasons = topology.fixed_reasons();
    add_groups(topology, rule.groups, reasons);
    return reasons;
  }
  auto reasons = without(topology.fixed_reasons(), by_rule);
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
    if (topology.on_boundary()[i]) reasons[i] |= bit(FixedReason::boundary);
  return reasons;
}

bool any_node_has(const Topology& topology, FixedReasons reasons) {
  const auto& of_nodes = topology.fixed_reasons();
  return std::any_of(of_nodes.begin(), of_nodes.end(),
                     [&](FixedReasons of_node) { return (of_node & reasons) != 0; });
}

std::array<std::size_t, fixed_reasons.size()> count_fixed_reasons(const Topology& topology) {
  const MeshPart* const part = topology.part();
  std::array<std::int64_t, fixed_reasons.size()> counts{};
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
    if (!part || part->owns_node(i))
      for (std::size_t r = 0; r < counts.size(); ++r)
        counts[r] += has(topology.fixed_reasons(i), fixed_reasons[r].reason);
  if (part) part->sum(counts);
  std::array<std::size_t, fixed_reasons.size()> result;
  std::copy(counts.begin(), counts.end(), result.begin());
  return result;
}

std::size_t n_midside_nodes(const Topology& topology) {
  return topology.n_nodes() - topology.free_nodes().size() - n_fixed_nodes(topology);
}

std::size_t n_fixed_nodes(const Topology& topology) {
  const MeshPart* const part = topology.part();
  std::size_t n = 0;
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
    n += topology.reasons_to_stay(i) != 0 && (!part || part->owns_node(i));
  return part ? part->sum(n) : n;
}

std::string fixed_reasons_text(const Topology& topology) {
  const std::size_t n_fixed = n_fixed_nodes(topology);
  if (n_fixed == 0) return {};
  std::string text;
  const auto counts = count_fixed_reasons(topology);
  for (std::size_t r = 0; r < counts.size(); ++r)
    if (counts[r] > 0)
      text += (text.empty() ? "" : ", ") + std::to_string(counts[r]) + " " + reason_texts[r];
  return std::to_string(n_fixed) + (n_fixed == 1 ? " node stays: " : " nodes stay: ") + text;
}

void add_marks(const std::vector<bool>& flags, std::vector<FixedReasons>& reasons) {
  FixedReasons said_by_mesh = bit(FixedReason::boundary) | bit(FixedReason::interface);
  for (std::size_t i = 0; i < flags.size(); ++i)
    if (!flags[i]) said_by_mesh &= static_cast<FixedReasons>(~reasons[i]);
  for (std::size_t i = 0; i < flags.size(); ++i)
    if (flags[i] && (reasons[i] & said_by_mesh) == 0) reasons[i] |= bit(FixedReason::marked);
}

void add_implied_reasons(const Topology& topology, std::vector<FixedReasons>& reasons) {
  const auto add = [&](const std::vector<bool>& flags, FixedReason reason) {
    for (std::size_t i = 0; i < flags.size(); ++i)
      if (flags[i]) reasons[i] |= bit(reason);
  };
  add(interface_nodes(topology), FixedReason::interface);
  add(required_nodes(topology), FixedReason::required);
  if (!topology.labels().content) return;
  for (const PeriodicEntity& periodic : topology.labels().content->periodic)
    for (const auto& pair : periodic.nodes)
      for (const NodeIndex node : pair) reasons[node] |= bit(FixedReason::periodic);
}

}  // namespace smoothfem
