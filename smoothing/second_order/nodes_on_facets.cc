// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/second_order/nodes_on_facets.h"

#include "smoothing/mesh/interfaces.h"

namespace smoothfem {

std::vector<bool> midside_nodes_on_facets(const Topology& topology) {
  std::vector<bool> flags(topology.n_nodes(), false);
  for (const auto& facets : {topology.boundary_facets(), inner_interfaces(topology).facets}) {
    const auto nodes = midside_of_facets(topology.dimension(), topology.cells(),
                                         topology.midside()->of_cells, facets);
    for (const NodeIndex node : nodes.entries())
      if (node != no_corner) flags[node] = true;
  }
  return flags;
}

}  // namespace smoothfem
