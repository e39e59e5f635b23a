// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/surface/sliding_boundary.h"

#include "smoothing/mesh/boundary_tags.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/mesh/interfaces.h"

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
                                 double slide_distance, SlidingSurfaces what) {
  require_slide_distance(slide_distance);
  const Topology& topology = mesh.topology();
  std::vector<FixedReasons> reasons = topology.fixed_reasons();
  const auto free = [&](NodeIndex i, FixedReasons removed) {
    reasons[i] &= static_cast<FixedReasons>(~removed);
  };
  SurfaceFacets surfaces;
  if (what.boundary) {
    surfaces = {topology.boundary_facets(), boundary_tags(topology), {}};
    // What the file marks on the boundary may be nothing but the boundary.
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      if (topology.on_boundary()[i]) free(i, bit(FixedReason::boundary) | bit(FixedReason::marked));
  }
  if (what.interfaces) {
    const Interfaces interfaces = inner_interfaces(topology);
    if (surfaces.tags.empty()) surfaces.tags.assign(surfaces.nodes.size(), 0);
    const auto points = labelled_points(topology);
    for (std::size_t f = 0; f < interfaces.facets.size(); ++f) {
      surfaces.nodes.append(interfaces.facets[f]);
      surfaces.tags.push_back(interfaces.tags[f]);
      for (const NodeIndex i : interfaces.facets[f])
        if (points.empty() || !points[i]) free(i, bit(FixedReason::interface));
    }
  }
  auto constraints = std::make_shared<const SurfaceConstraints>(
      surfaces, mesh.coordinates(), parameters,
      slide_distance * mean_edge_length(surfaces.nodes, mesh.coordinates()));
  return with_fixed_nodes(
      VolumeMesh(mesh.shared_topology(), mesh.copied_coordinates(), std::move(constraints)),
      std::move(reasons));
}

}  // namespace smoothfem
