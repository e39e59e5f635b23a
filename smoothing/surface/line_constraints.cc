// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/surface/line_constraints.h"

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

/// Builds a wall on the curves. The lower edge of the wall consists of feature lines, which end at
/// the wall's upright edges. So the constraints of a surface apply.
LineConstraints::LineConstraints(const SurfaceFacets& edges, std::span<const Point<2>> coordinates,
                                 const FeatureParameters& parameters, double facet_bound)
    : edges_(edges.nodes),
      node_edges_(rows_by_entry(edges.nodes, coordinates.size())),
      facet_bound_(facet_bound),
      wall_nodes_(coordinates.size(), absent),
      classifications_(coordinates.size()) {
  const double height = mean_length(edges_, coordinates);
  std::vector<Point<3>> points;
  for (const auto& rows : {edges_, edges.midside})
    for (const NodeIndex node : rows.entries())
      if (node != no_corner && wall_nodes_[node] == absent) {
        wall_nodes_[node] = static_cast<NodeIndex>(points.size());
        points.push_back(in_space(coordinates[node]));
      }
  const auto n = static_cast<NodeIndex>(points.size());
  for (NodeIndex i = 0; i < n; ++i) points.push_back(points[i] + height * Point<3>::UnitZ());
  SurfaceFacets wall{{}, edges.tags, {}};
  if (edges.midside.size() > 0)  // nodes in the middle of the wall's upright edges
    for (NodeIndex i = 0; i < n; ++i)
      points.push_back(points[i] + 0.5 * height * Point<3>::UnitZ());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const NodeIndex a = wall_nodes_[edges_[e][0]], b = wall_nodes_[edges_[e][1]];
    wall.nodes.append(std::array{a, b, b + n, a + n});
    if (edges.midside.size() == 0) continue;
    std::array<NodeIndex, 4> row;
    row.fill(no_corner);
    if (edges.midside[e][0] != no_corner) {
      const NodeIndex middle = wall_nodes_[edges.midside[e][0]];
      row = {middle, b + 2 * n, middle + n, a + 2 * n};
    }
    wall.midside.append(row);
  }
  wall_ = std::make_unique<const SurfaceConstraints>(wall, points, parameters);
  for (NodeIndex i = 0; i < classifications_.size(); ++i)
    if (wall_nodes_[i] != absent) classifications_[i] = wall_->classifications()[wall_nodes_[i]];
}

Point<2> LineConstraints::project(NodeIndex node, const Point<2>& from,
                                  const Point<2>& wanted) const {
  if (wall_nodes_[node] == absent) return wanted;
  return wall_->project(wall_nodes_[node], in_space(from), in_space(wanted)).head<2>();
}

double LineConstraints::distance(const Point<2>& point) const {
  return wall_->distance(in_space(point));
}

double LineConstraints::distance_of(std::uint32_t edge, std::span<const Point<2>> x) const {
  return distance(0.5 * (x[edges_[edge][0]] + x[edges_[edge][1]]));
}

double LineConstraints::facet_distance(std::span<const Point<2>> coordinates) const {
  double largest = 0.0;
  for (std::uint32_t e = 0; e < edges_.size(); ++e)
    largest = std::max(largest, distance_of(e, coordinates));
  return largest;
}

std::vector<std::uint32_t> LineConstraints::facets_out_of_bound(
    std::span<const Point<2>> coordinates) const {
  std::vector<std::uint32_t> found;
  if (facet_bound_ == unbounded) return found;
  for (std::uint32_t e = 0; e < edges_.size(); ++e)
    if (is_out_of_bound(e, coordinates)) found.push_back(e);
  return found;
}

std::vector<std::uint32_t> LineConstraints::facets_out_of_bound(
    std::span<const Point<2>> coordinates, std::span<const NodeIndex> around) const {
  std::vector<std::uint32_t> found;
  if (facet_bound_ == unbounded) return found;
  for (const NodeIndex node : around)
    for (const std::uint32_t e : node_edges_[node])
      if (is_out_of_bound(e, coordinates)) found.push_back(e);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

bool LineConstraints::keeps_bound(std::span<const Point<2>> coordinates,
                                  std::span<const NodeIndex> around) const {
  if (facet_bound_ == unbounded) return true;
  return std::all_of(around.begin(), around.end(), [&](NodeIndex node) {
    return std::none_of(node_edges_[node].begin(), node_edges_[node].end(),
                        [&](std::uint32_t e) { return is_out_of_bound(e, coordinates); });
  });
}

}  // namespace smoothfem
