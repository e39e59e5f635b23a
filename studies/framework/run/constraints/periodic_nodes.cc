// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/constraints/periodic_nodes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "fem/solutions/check_solution.h"
#include "meshes/doctor/examinations/disjoint_sets.h"
#include "smoothing/base/input_error.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

namespace {

/// Calls visit(entity, node, partner) for all pairs of different nodes.
template <class Visit>
void for_each_pair(const Topology& topology, const Visit& visit) {
  const FileContent* content = topology.labels().content.get();
  if (content == nullptr) return;
  for (const auto& entity : content->periodic)
    for (const auto& [node, partner] : entity.nodes)
      if (node != partner) visit(entity, node, partner);
}

/// Returns the first node of each node's class of partners: for most nodes the node itself.
std::vector<NodeIndex> first_partners(const Topology& topology) {
  DisjointSets classes(topology.n_nodes());
  for_each_pair(topology, [&](const PeriodicEntity&, NodeIndex node, NodeIndex partner) {
    classes.join(node, partner);
  });
  std::vector<NodeIndex> first(topology.n_nodes());
  for (NodeIndex node = 0; node < first.size(); ++node) first[node] = classes.first_of(node);
  return first;
}

/// Returns whether partners are moved images of each other, without rotation.
bool is_translation(const PeriodicEntity& entity) {
  for (std::size_t k = 0; k < entity.affine.size() && k < 11; ++k)
    if (k % 4 != 3 && std::abs(entity.affine[k] - (k % 5 == 0 ? 1.0 : 0.0)) > 1e-9) return false;
  return true;
}

}  // namespace

std::size_t n_periodic_nodes(const Topology& topology) {
  std::set<NodeIndex> nodes;
  for_each_pair(topology, [&](const PeriodicEntity&, NodeIndex node, NodeIndex partner) {
    nodes.insert({node, partner});
  });
  return nodes.size();
}

NodeTies periodic_ties(const Topology& topology) {
  const auto first = first_partners(topology);
  NodeTies ties;
  for (NodeIndex node = 0; node < first.size(); ++node)
    if (first[node] != node) ties.nodes.push_back({node, {{first[node], 1.0}}});
  if (ties.empty()) return ties;
  std::map<std::vector<NodeIndex>, std::vector<std::size_t>> facets;  // by their first partners
  for (std::size_t f = 0; f < topology.boundary_facets().size(); ++f) {
    std::vector<NodeIndex> partners;
    for (const NodeIndex node : topology.boundary_facets()[f]) partners.push_back(first[node]);
    std::sort(partners.begin(), partners.end());
    facets[partners].push_back(f);
  }
  for (const auto& [partners, pair] : facets) {
    if (pair.size() != 2) continue;
    for (const std::size_t f : pair) {
      const auto nodes = topology.boundary_facets()[f];
      std::vector<NodeIndex> facet(nodes.begin(), nodes.end());
      std::sort(facet.begin(), facet.end());
      ties.inner_facets.insert(std::move(facet));
    }
  }
  if (ties.inner_facets.size() == topology.boundary_facets().size())
    throw InputError(
        "the whole boundary is periodic, which determines the solution only up to a constant: "
        "leave out 'set periodic = constrain', or the periodic partners of a part");
  return ties;
}

template <int dim>
void require_periodic(const ManufacturedSolution<dim>& solution, const Mesh<dim>& mesh) {
  constexpr double allowed = 1e-6;
  double largest = 0.0, steepest = 0.0;
  for (const auto& p : mesh.coordinates()) {
    const auto at = solution.value_and_gradient(p);
    largest = std::max(largest, std::abs(at.value));
    steepest = std::max(steepest, at.gradient.norm());
  }
  for_each_pair(mesh.topology(), [&](const PeriodicEntity& entity, NodeIndex i, NodeIndex j) {
    const Point<dim>&a = mesh.coordinates()[i], &b = mesh.coordinates()[j];
    const auto at_a = solution.value_and_gradient(a), at_b = solution.value_and_gradient(b);
    const bool has_same_value = std::abs(at_a.value - at_b.value) <= allowed * largest;
    const bool has_same_slope =
        !is_translation(entity) || (at_a.gradient - at_b.gradient).norm() <= allowed * steepest;
    if (!has_same_value || !has_same_slope)
      throw InputError(std::string("the solution's ") + (has_same_value ? "gradient" : "u") +
                       " at " + point_text<dim>(a) + " is not that at its periodic partner " +
                       point_text<dim>(b) +
                       ": choose a periodic solution, or leave out 'set periodic = constrain'");
  });
}
template void require_periodic(const ManufacturedSolution<2>&, const Mesh<2>&);
template void require_periodic(const ManufacturedSolution<3>&, const Mesh<3>&);

}  // namespace smoothfem
