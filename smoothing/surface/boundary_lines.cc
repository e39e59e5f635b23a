// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/surface/boundary_lines.h"

#include <algorithm>
#include <array>

namespace smoothfem {

namespace {

constexpr NodeIndex absent = UINT32_MAX;

Point<3> in_space(const Point<2>& p) {
  return {p.x(), p.y(), 0.0};
}

double mean_length(const CompressedRows<NodeIndex>& edges, std::span<const Point<2>> x) {
  double sum = 0.0;
  for (std::size_t e = 0; e < edges.size(); ++e) sum += (x[edges[e][1]] - x[edges[e][0]]).norm();
  return sum / static_cast<double>(edges.size());
}

}  // namespace

/// Builds a wall on the boundary. Its lower edge is one feature line, or several that end at the
/// wall's upright edges. So the constraints of a surface apply.
BoundaryLines::BoundaryLines(const PlanarMesh& mesh, const FeatureParameters& parameters,
                             double slide_distance)
    : topology_(mesh.shared_topology()),
      wall_nodes_(mesh.n_nodes(), absent),
      node_edges_(rows_by_entry(mesh.topology().boundary_facets(), mesh.n_nodes())) {
  require_slide_distance(slide_distance);
  const auto& edges = topology_->boundary_facets();
  const double length = mean_length(edges, mesh.coordinates());
  std::vector<Point<3>> points;
  for (const NodeIndex node : edges.entries())
    if (wall_nodes_[node] == absent) {
      wall_nodes_[node] = static_cast<NodeIndex>(points.size());
      points.push_back(in_space(mesh.coordinates()[node]));
    }
  const auto n = static_cast<NodeIndex>(points.size());
  for (NodeIndex i = 0; i < n; ++i) points.push_back(points[i] + length * Point<3>::UnitZ());
  SurfaceFacets wall;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const NodeIndex a = wall_nodes_[edges[e][0]], b = wall_nodes_[edges[e][1]];
    wall.nodes.append(std::array{a, b, b + n, a + n});
  }
  edge_bound_ = slide_distance * length;
  wall_ = std::make_unique<const SurfaceConstraints>(wall, points, parameters);
}

bool BoundaryLines::is_corner(NodeIndex node) const {
  return wall_nodes_[node] != absent && wall_->is_corner(wall_nodes_[node]);
}

int BoundaryLines::n_directions(NodeIndex node) const {
  return wall_nodes_[node] == absent ? 2 : is_corner(node) ? 0 : 1;
}

Point<2> BoundaryLines::project(NodeIndex node, const Point<2>& from,
                                const Point<2>& wanted) const {
  if (wall_nodes_[node] == absent) return wanted;
  return wall_->project(wall_nodes_[node], in_space(from), in_space(wanted)).head<2>();
}

double BoundaryLines::distance(std::span<const NodeIndex> edge, std::span<const Point<2>> x) const {
  return wall_->distance(in_space(0.5 * (x[edge[0]] + x[edge[1]])));
}

bool BoundaryLines::keeps_bound(std::span<const Point<2>> x, NodeIndex node) const {
  if (edge_bound_ == NodeConstraints::unbounded) return true;
  return std::all_of(node_edges_[node].begin(), node_edges_[node].end(), [&](std::uint32_t e) {
    return distance(topology_->boundary_facets()[e], x) <= edge_bound_;
  });
}

double BoundaryLines::edge_distance(std::span<const Point<2>> x) const {
  double largest = 0.0;
  for (std::size_t e = 0; e < topology_->boundary_facets().size(); ++e)
    largest = std::max(largest, distance(topology_->boundary_facets()[e], x));
  return largest;
}

}  // namespace smoothfem
