// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/surface/sliding_boundary.h"

#include "smoothing/mesh/boundary_tags.h"
#include "smoothing/mesh/fixed_nodes.h"

namespace smoothfem {

namespace {

/// Mean over the sides of all facets; each side belongs to two facets.
double mean_edge_length(const CompressedRows<NodeIndex>& facets, std::span<const Point<3>> x) {
  double sum = 0.0;
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (std::size_t k = 0, n = facets[f].size(); k < n; ++k)
      sum += (x[facets[f][k]] - x[facets[f][k + 1 < n ? k + 1 : 0]]).norm();
  return sum / static_cast<double>(facets.n_entries());
}

}  // namespace

VolumeMesh with_sliding_boundary(const VolumeMesh& mesh, const FeatureParameters& parameters,
                                 double slide_distance) {
  require_slide_distance(slide_distance);
  const Topology& topology = mesh.topology();
  const SurfaceFacets boundary{topology.boundary_facets(), boundary_tags(topology), {}};
  auto constraints = std::make_shared<const SurfaceConstraints>(
      boundary, mesh.coordinates(), parameters,
      slide_distance * mean_edge_length(boundary.nodes, mesh.coordinates()));
  std::vector<bool> fixed(mesh.n_nodes());
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    fixed[i] = topology.is_fixed(i) && !topology.on_boundary()[i];
  return with_fixed_nodes(
      VolumeMesh(mesh.shared_topology(), mesh.copied_coordinates(), std::move(constraints)),
      std::move(fixed));
}

}  // namespace smoothfem
