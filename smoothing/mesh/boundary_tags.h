// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// Returns the tags of the boundary facets in their order, 0 for those without a label; empty if
/// the mesh has no labelled facets.
std::vector<int> boundary_tags(const Topology& topology);

}  // namespace smoothfem
