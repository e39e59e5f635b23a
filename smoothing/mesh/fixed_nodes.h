// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "smoothing/mesh/node_constraints.h"

namespace smoothfem {

/// Rule for the nodes that smoothing must not move. Nodes that no cell uses are always fixed.
struct FixedNodesRule {
  enum class Kind {
    boundary,  ///< nodes of boundary facets
    file,      ///< as in the topology: the file's flags, or the boundary if the file has none
    groups,    ///< nodes of the labelled facets in `groups`
    none       ///< every node is free
  };
  Kind kind = Kind::boundary;
  std::vector<std::string> groups;  ///< physical tags or names of facets
};

/// Parses a user's rule: "boundary", "file", "free" or "group=NAME[,NAME...]". Throws InputError
/// that lists these for any other text.
FixedNodesRule parse_fixed_nodes_rule(const std::string& text);

/// Returns one flag for each node. Throws InputError for a group that no facet has; the message
/// lists the available groups.
std::vector<bool> fixed_nodes(const Topology& topology, const FixedNodesRule& rule);

/// Returns the mesh with other fixed nodes. fixed: one flag for each node. Corners of its surface
/// are always fixed.
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
