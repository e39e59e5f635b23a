// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// Returns flags of the midside nodes on facets of the boundary and of interfaces, by node.
std::vector<bool> midside_nodes_on_facets(const Topology& topology);

}  // namespace smoothfem
