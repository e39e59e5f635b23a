// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <set>
#include <string>
#include <vector>

#include "fem/ranks/ranks.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// The facets of a mesh (edges in the plane, faces in space) on which the natural condition
/// A grad u . n = g holds, by the mesh's numbers of nodes. Elsewhere on the boundary u is given.
class NaturalBoundary {
 public:
  /// topology: on the root, null elsewhere. groups: physical tags or names of facets, which the
  /// topology has (require_natural_groups). Collective.
  NaturalBoundary(const Topology* topology, const std::vector<std::string>& groups,
                  const Ranks& ranks);

  bool empty() const { return facets_.empty(); }
  bool contains(std::vector<NodeIndex> facet) const;
  /// Nodes of each facet in the direction of its cell: counterclockwise around it, seen from
  /// outside.
  const std::vector<std::vector<NodeIndex>>& facets() const { return facets_; }

 private:
  std::vector<std::vector<NodeIndex>> facets_;
  std::set<std::vector<NodeIndex>> sorted_;
};

/// Throws InputError for a group that no facet has, naming those there are, or that has none on the
/// boundary; and if all of the boundary is in one of the groups.
void require_natural_groups(const Topology& topology, const std::vector<std::string>& groups);

}  // namespace smoothfem
