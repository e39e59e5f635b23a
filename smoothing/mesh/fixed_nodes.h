// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "smoothing/mesh/node_constraints.h"

namespace smoothfem {

/// Which nodes smoothing must not move. Nodes that no cell uses are fixed in any case.
struct FixedNodesRule {
  enum class Kind {
    boundary,  ///< nodes of boundary facets
    file,      ///< as the topology says: the file's flags, or the boundary where it has none
    groups,    ///< nodes of the labelled facets in `groups`
    none       ///< every node is free
  };
  Kind kind = Kind::boundary;
  std::vector<std::string> groups;  ///< physical tags or names of facets
};

/// The rule that a user writes: "boundary", "file", "free" or "group=NAME[,NAME...]". Throws
/// InputError that lists these for anything else.
FixedNodesRule parse_fixed_nodes_rule(const std::string& text);

/// One flag a node. Throws InputError for a group that no facet has; it names those there are.
std::vector<bool> fixed_nodes(const Topology& topology, const FixedNodesRule& rule);

/// The same mesh with other fixed nodes. fixed: one flag a node. Corners of its surface are fixed
/// in any case.
template <int dim, int spacedim>
Mesh<dim, spacedim> with_fixed_nodes(Mesh<dim, spacedim> mesh, std::vector<bool> fixed) {
  const Topology& old = mesh.topology();
  if (mesh.constraints())
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      if (mesh.constraints()->is_corner(i)) fixed[i] = true;
  auto topology = std::make_shared<const Topology>(dim, old.n_nodes(), old.cells(),
                                                   std::move(fixed), old.labels());
  auto constraints = mesh.shared_constraints();
  return {std::move(topology), std::move(mesh).take_coordinates(), std::move(constraints)};
}

}  // namespace smoothfem
