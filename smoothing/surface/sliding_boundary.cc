#include "smoothing/surface/sliding_boundary.h"

#include <algorithm>
#include <map>

#include "smoothing/mesh/fixed_nodes.h"

namespace smoothfem {

namespace {

std::vector<NodeIndex> sorted(std::span<const NodeIndex> nodes) {
  std::vector<NodeIndex> result(nodes.begin(), nodes.end());
  std::sort(result.begin(), result.end());
  return result;
}

/// Tags of the boundary facets, 0 for those without label.
std::vector<int> boundary_tags(const Topology& topology) {
  const MeshLabels& labels = topology.labels();
  if (labels.facets.empty()) return {};
  std::map<std::vector<NodeIndex>, int> tags;
  for (std::size_t f = 0; f < labels.facets.size(); ++f)
    tags[sorted(labels.facets[f])] = labels.facet_tags[f];
  std::vector<int> result;
  for (std::size_t f = 0; f < topology.boundary_facets().size(); ++f) {
    const auto found = tags.find(sorted(topology.boundary_facets()[f]));
    result.push_back(found == tags.end() ? 0 : found->second);
  }
  return result;
}

}  // namespace

VolumeMesh with_sliding_boundary(const VolumeMesh& mesh, const FeatureParameters& parameters) {
  const Topology& topology = mesh.topology();
  const SurfaceFacets boundary{topology.boundary_facets(), boundary_tags(topology), {}};
  auto constraints =
      std::make_shared<const NodeConstraints>(boundary, mesh.coordinates(), parameters);
  std::vector<bool> fixed(mesh.n_nodes());
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    fixed[i] = topology.is_fixed(i) && !topology.on_boundary()[i];
  return with_fixed_nodes(
      VolumeMesh(mesh.shared_topology(), mesh.coordinates(), std::move(constraints)),
      std::move(fixed));
}

double boundary_deviation(const VolumeMesh& mesh) {
  const auto& x = mesh.coordinates();
  double largest = 0.0;
  const auto& facets = mesh.topology().boundary_facets();
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto nodes = facets[f];
    const std::size_t n = nodes.size();
    Point<3> middle = Point<3>::Zero();
    for (std::size_t k = 0; k < n; ++k) {
      middle += x[nodes[k]] / static_cast<double>(n);
      const Point<3> of_side = 0.5 * (x[nodes[k]] + x[nodes[k + 1 < n ? k + 1 : 0]]);
      largest = std::max(largest, mesh.constraints()->distance(of_side));
    }
    largest = std::max(largest, mesh.constraints()->distance(middle));
  }
  return largest;
}

}  // namespace smoothfem
