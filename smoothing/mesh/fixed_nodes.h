// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "smoothing/mesh/node_constraints.h"

namespace smoothfem {

/// Rule for the nodes that smoothing must not move. In addition, nodes stay for what the mesh
/// implies: interfaces, periodic partners and the other reasons of fixed_reason.h.
struct FixedNodesRule {
  enum class Kind {
    boundary,  ///< nodes of boundary facets
    file,      ///< as in the topology: the file's flags, or the boundary if the file has none
    groups,    ///< as `file`, and the nodes of the facets, edges and points in `groups`
    none       ///< not even the nodes that the file marks or requires
  };
  Kind kind = Kind::boundary;
  std::vector<std::string> groups;  ///< physical tags or names
};

/// Parses a user's rule: "boundary", "file", "free" or "group=NAME[,NAME...]". Throws InputError
/// that lists these for any other text.
FixedNodesRule parse_fixed_nodes_rule(const std::string& text);

/// Returns for each node why it stays. Throws InputError for a group that no element below the
/// cells' dimension has; the message lists the available groups.
std::vector<FixedReasons> fixed_nodes(const Topology& topology, const FixedNodesRule& rule);

/// Returns the reasons of a topology without some of them.
std::vector<FixedReasons> without(const std::vector<FixedReasons>& reasons, FixedReasons removed);

/// True if some node stays for one of these reasons.
bool any_node_has(const Topology& topology, FixedReasons reasons);

/// Returns the number of nodes that follow their corners (midside_nodes.h).
std::size_t n_midside_nodes(const Topology& topology);
/// Returns the number of nodes that stay. This function and those below count the nodes of the
/// whole mesh; in a part they are collective.
std::size_t n_fixed_nodes(const Topology& topology);

/// Number of nodes that stay for each reason, in the order of fixed_reasons. Nodes with several
/// reasons count for each.
std::array<std::size_t, fixed_reasons.size()> count_fixed_reasons(const Topology& topology);

/// Returns, for example, "104 nodes stay: 96 on the boundary, 12 on interfaces between groups";
/// empty if no node stays.
std::string fixed_reasons_text(const Topology& topology);

/// Adds the reasons that follow from the labels of a mesh: interfaces, required elements and
/// periodic partners.
void add_implied_reasons(const Topology& topology, std::vector<FixedReasons>& reasons);

/// Adds the marks of a file, one flag for each node. Marks of all nodes of the boundary, or of all
/// those of interfaces, say no more than the mesh itself: these nodes are not marked in addition.
void add_marks(const std::vector<bool>& flags, std::vector<FixedReasons>& reasons);

/// Returns the mesh with other fixed nodes. reasons: for each node why it stays. Corners of its
/// constraints are always fixed.
template <int dim, int spacedim>
Mesh<dim, spacedim> with_fixed_nodes(Mesh<dim, spacedim> mesh, std::vector<FixedReasons> reasons) {
  const Topology& old = mesh.topology();
  if (mesh.constraints())
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      if (mesh.constraints()->is_corner(i)) reasons[i] |= bit(FixedReason::corner);
  auto topology = std::make_shared<const Topology>(dim, old.n_nodes(), old.cells(),
                                                   std::move(reasons), old.labels());
  auto constraints = mesh.shared_constraints();
  auto targets = mesh.shared_targets();
  return {std::move(topology), std::move(mesh).take_coordinates(), std::move(constraints),
          std::move(targets)};
}

/// As above. fixed: one flag for each node. Nodes keep their present reasons to stay; others are
/// marked.
template <int dim, int spacedim>
Mesh<dim, spacedim> with_fixed_nodes(Mesh<dim, spacedim> mesh, const std::vector<bool>& fixed) {
  std::vector<FixedReasons> reasons = mesh.topology().fixed_reasons();
  for (std::size_t i = 0; i < reasons.size(); ++i)
    if (!fixed[i])
      reasons[i] = 0;
    else if (reasons[i] == 0)
      reasons[i] = bit(FixedReason::marked);
  return with_fixed_nodes(std::move(mesh), std::move(reasons));
}

}  // namespace smoothfem
