// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// Returns the tags of the boundary facets in their order, 0 for those without a label; empty if
/// the mesh has no labelled facets.
std::vector<int> boundary_tags(const Topology& topology);

/// True if a user's group, given by its tag or name, is that of a tag of elements of a dimension.
inline bool is_group(const MeshLabels& labels, int dimension, int tag, const std::string& group) {
  const auto name = labels.names.find({dimension, tag});
  return group == std::to_string(tag) || (name != labels.names.end() && group == name->second);
}

/// Returns tags with their names, which may be empty, for a message: "the mesh has the groups 4, 5
/// (inlet)".
std::string groups_text(const std::vector<std::pair<int, std::string>>& groups);

/// Returns the groups of labelled facets for a message.
std::string groups_of_boundary(const MeshLabels& labels, int dimension);

}  // namespace smoothfem
