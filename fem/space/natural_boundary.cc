// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/space/natural_boundary.h"

#include <algorithm>

#include "fem/materials/cell_kinds.h"
#include "smoothing/mesh/boundary_tags.h"
#include "smoothing/mesh/fixed_nodes.h"

namespace smoothfem {

namespace {

using Facet = std::vector<NodeIndex>;

Facet sorted(Facet facet) {
  std::sort(facet.begin(), facet.end());
  return facet;
}

/// Returns the boundary facets with the label of the group.
std::vector<Facet> facets_of_group(const Topology& topology, const std::string& group) {
  const MeshLabels& labels = topology.labels();
  std::set<Facet> labelled;
  for (std::size_t f = 0; f < labels.facets.size(); ++f) {
    if (is_group(labels, topology.dimension() - 1, labels.facet_tags[f], group))
      labelled.insert(sorted({labels.facets[f].begin(), labels.facets[f].end()}));
  }
  std::vector<Facet> facets;
  for (std::size_t f = 0; f < topology.boundary_facets().size(); ++f) {
    const auto nodes = topology.boundary_facets()[f];
    if (labelled.contains(sorted({nodes.begin(), nodes.end()})))
      facets.emplace_back(nodes.begin(), nodes.end());
  }
  return facets;
}

/// Returns the cell of a boundary facet.
CellIndex cell_of(const Topology& topology, const Facet& facet) {
  const auto cells = topology.node_cells(facet[0]);
  return *std::find_if(cells.begin(), cells.end(), [&](CellIndex cell) {
    const auto nodes = topology.cell_nodes(cell);
    return std::all_of(facet.begin(), facet.end(), [&](NodeIndex node) {
      return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
    });
  });
}

}  // namespace

NaturalBoundary::NaturalBoundary(const Topology* topology, const std::vector<std::string>& groups,
                                 const Ranks& ranks) {
  if (groups.empty()) return;
  const auto kinds = topology == nullptr ? std::vector<std::uint32_t>() : cell_kinds(*topology);
  std::vector<NodeIndex> numbers;  // for all facets: kind and number of nodes, then the nodes
  if (topology != nullptr)
    for (const auto& group : groups)
      for (const auto& facet : facets_of_group(*topology, group)) {
        numbers.push_back(kinds[cell_of(*topology, facet)]);
        numbers.push_back(static_cast<NodeIndex>(facet.size()));
        numbers.insert(numbers.end(), facet.begin(), facet.end());
      }
  ranks.broadcast(numbers);
  for (auto next = numbers.begin(); next != numbers.end();) {
    const std::uint32_t kind = *next++;
    const auto end = next + 1 + static_cast<std::ptrdiff_t>(*next);
    Facet facet(next + 1, end);
    if (sorted_.insert(sorted(facet)).second) {
      facets_.push_back(std::move(facet));
      kinds_.push_back(kind);
    }
    next = end;
  }
}

bool NaturalBoundary::contains(std::vector<NodeIndex> facet) const {
  return sorted_.contains(sorted(std::move(facet)));
}

void require_natural_groups(const Topology& topology, const std::vector<std::string>& groups) {
  if (groups.empty()) return;
  (void)fixed_nodes(topology, {FixedNodesRule::Kind::groups, groups});  // refuses unknown ones
  std::set<Facet> natural;
  for (const auto& group : groups) {
    const auto facets = facets_of_group(topology, group);
    if (facets.empty())
      throw InputError("the group '" + group +
                       "' has a natural condition, but no facet on the boundary: name groups of "
                       "the boundary only");
    natural.insert(facets.begin(), facets.end());
  }
  if (natural.size() == topology.boundary_facets().size())
    throw InputError(
        "the whole boundary has natural conditions, which determine the solution only up to a "
        "constant: remove a group from 'natural'");
}

}  // namespace smoothfem
