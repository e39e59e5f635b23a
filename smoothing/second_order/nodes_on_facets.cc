// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/second_order/nodes_on_facets.h"

#include <algorithm>
#include <set>

#include "smoothing/mesh/interfaces.h"

namespace smoothfem {

namespace {

/// Returns the places of the midside nodes of these facets, and of their edges.
std::set<MidsidePlace> places_of_facets(int dim, const CompressedRows<NodeIndex>& facets) {
  std::set<MidsidePlace> places;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto nodes = facets[f];
    std::vector<NodeIndex> sorted(nodes.begin(), nodes.end());
    std::sort(sorted.begin(), sorted.end());
    MidsidePlace whole{no_corner, no_corner, no_corner, no_corner};
    std::copy(sorted.begin(), sorted.end(), whole.begin());
    places.insert(whole);
    if (dim == 3)
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        const auto [low, high] = std::minmax(nodes[k], nodes[(k + 1) % nodes.size()]);
        places.insert({low, high, no_corner, no_corner});
      }
  }
  return places;
}

}  // namespace

std::vector<bool> midside_nodes_on_facets(const Topology& topology) {
  const int dim = topology.dimension();
  auto places = places_of_facets(dim, topology.boundary_facets());
  places.merge(places_of_facets(dim, inner_interfaces(topology).facets));
  std::vector<bool> flags(topology.n_nodes(), false);
  for (CellIndex c = 0; c < topology.n_cells(); ++c)
    for_each_midside_place(dim, topology.cell_nodes(c), topology.midside_nodes(c),
                           [&](const MidsidePlace& place, NodeIndex node) {
                             flags[node] = flags[node] || places.contains(place);
                           });
  return flags;
}

}  // namespace smoothfem
