// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// Tags of the boundary's facets, in their order, 0 for those without label; empty if the mesh has
/// no labelled facets.
std::vector<int> boundary_tags(const Topology& topology);

}  // namespace smoothfem
