// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "fem/ranks/ranks.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// The facets of a mesh (edges in the plane, faces in space) on which the natural condition A grad
/// u . n = g holds, by the mesh's node numbers. On the rest of the boundary u is given.
class NaturalBoundary {
 public:
  /// topology: on the root, null elsewhere. groups: physical tags or names of facets that the
  /// topology has (require_natural_groups). Collective.
  NaturalBoundary(const Topology* topology, const std::vector<std::string>& groups,
                  const Ranks& ranks);

  bool empty() const { return facets_.empty(); }
  bool contains(std::vector<NodeIndex> facet) const;
  /// Returns the nodes of each facet in the direction of its cell: counterclockwise, seen from
  /// outside.
  const std::vector<std::vector<NodeIndex>>& facets() const { return facets_; }
  /// Returns the kind of each facet's cell (cell_kinds).
  const std::vector<std::uint32_t>& kinds() const { return kinds_; }

 private:
  std::vector<std::vector<NodeIndex>> facets_;
  std::vector<std::uint32_t> kinds_;
  std::set<std::vector<NodeIndex>> sorted_;
};

/// Throws InputError for a group that no facet has (the message lists the available ones) or that
/// has no facet on the boundary. Throws it also if the groups cover the whole boundary.
void require_natural_groups(const Topology& topology, const std::vector<std::string>& groups);

}  // namespace smoothfem
