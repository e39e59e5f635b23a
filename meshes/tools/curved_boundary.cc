// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/curved_boundary.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "smoothing/mesh/midside_nodes.h"
#include "smoothing/second_order/raise_order.h"

namespace smoothfem {

namespace {

MidsidePlace edge_between(NodeIndex a, NodeIndex b) {
  return {std::min(a, b), std::max(a, b), no_corner, no_corner};
}

/// Returns the midside nodes of all edges of boundary facets.
template <int dim>
std::map<MidsidePlace, NodeIndex> boundary_nodes(const Topology& topology) {
  std::map<MidsidePlace, NodeIndex> nodes;
  const auto& facets = topology.boundary_facets();
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (std::size_t k = 0; k < facets[f].size(); ++k)
      nodes[edge_between(facets[f][k], facets[f][(k + 1) % facets[f].size()])] = no_corner;
  for (CellIndex c = 0; c < topology.n_cells(); ++c)
    for_each_midside_place(dim, topology.cell_nodes(c), topology.midside_nodes(c),
                           [&](const MidsidePlace& place, NodeIndex node) {
                             if (const auto found = nodes.find(place); found != nodes.end())
                               found->second = node;
                           });
  return nodes;
}

}  // namespace

template <int dim>
Mesh<dim> with_curved_boundary(const Mesh<dim>& linear, const OntoBoundary<dim>& onto) {
  Mesh<dim> mesh = with_midside_nodes(linear, SecondOrderKind::serendipity);
  const auto nodes = boundary_nodes<dim>(mesh.topology());
  const auto x = mesh.coordinates();
  const auto& facets = mesh.topology().boundary_facets();
  for (std::size_t f = 0; f < facets.size(); ++f) {
    std::vector<Point<dim>> corners;
    for (const NodeIndex node : facets[f]) corners.push_back(x[node]);
    for (std::size_t k = 0; k < (dim == 2 ? 1 : corners.size()); ++k) {
      const NodeIndex node =
          nodes.at(edge_between(facets[f][k], facets[f][(k + 1) % corners.size()]));
      x[node] = onto(corners, x[node]);
    }
  }
  return mesh;
}

OntoBoundary<2> boundary_through(const Polygons& corners, const Polygons& middles) {
  using Edge = std::array<double, 4>;
  const auto edge = [](Point<2> a, Point<2> b) {
    if (std::pair(b.x(), b.y()) < std::pair(a.x(), a.y())) std::swap(a, b);
    return Edge{a.x(), a.y(), b.x(), b.y()};
  };
  std::map<Edge, Point<2>> middle_of;
  for (std::size_t p = 0; p < corners.size(); ++p)
    for (std::size_t i = 0; i < corners[p].size(); ++i)
      middle_of[edge(corners[p][i], corners[p][(i + 1) % corners[p].size()])] = middles[p][i];
  return [=](std::span<const Point<2>> ends, const Point<2>& point) {
    const auto found = middle_of.find(edge(ends[0], ends[1]));
    return found == middle_of.end() ? point : found->second;
  };
}

template Mesh<2> with_curved_boundary(const Mesh<2>&, const OntoBoundary<2>&);
template Mesh<3> with_curved_boundary(const Mesh<3>&, const OntoBoundary<3>&);

}  // namespace smoothfem
