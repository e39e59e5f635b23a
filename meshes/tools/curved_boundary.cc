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

template <int dim>
Mesh<dim> with_curved_boundary(const Mesh<dim>& linear, const OntoBoundary<dim>& onto) {
  Mesh<dim> mesh = with_midside_nodes(linear, SecondOrderKind::serendipity);
  const Topology& topology = mesh.topology();
  const auto& facets = topology.boundary_facets();
  const auto midside =
      midside_of_facets(dim, topology.cells(), topology.midside()->of_cells, facets);
  const auto x = mesh.coordinates();
  for (std::size_t f = 0; f < facets.size(); ++f) {
    std::vector<Point<dim>> corners;
    for (const NodeIndex node : facets[f]) corners.push_back(x[node]);
    for (const NodeIndex node : midside[f]) x[node] = onto(corners, x[node]);
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
