// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/surface/surface_constraints.h"

#include <algorithm>
#include <array>
#include <optional>

#include "smoothing/base/parallel.h"
#include "smoothing/geometry/cell_size.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/mesh/interfaces.h"
#include "smoothing/surface/piece_index.h"

namespace smoothfem {

namespace {

Piece curved_piece(std::span<const NodeIndex> nodes, std::span<const Point<3>> x,
                   std::uint32_t part) {
  std::vector<Point<3>> points;
  for (const NodeIndex node : nodes) points.push_back(x[node]);
  return {points[0], points[1], points[2], part, std::make_shared<const QuadraticPiece>(points)};
}

std::vector<Piece> triangles_of(const SurfaceFacets& facets, std::span<const Point<3>> x,
                                const std::vector<std::uint32_t>& patches) {
  std::vector<Piece> triangles;
  for (std::uint32_t f = 0; f < facets.nodes.size(); ++f) {
    if (const auto curved = facets.curved_nodes(f); !curved.empty()) {
      triangles.push_back(curved_piece(curved, x, patches[f]));
      continue;
    }
    const auto nodes = facets.nodes[f];
    const std::size_t n = nodes.size();
    if (n == 3) {
      triangles.push_back({x[nodes[0]], x[nodes[1]], x[nodes[2]], patches[f]});
      continue;
    }
    Point<3> centre = Point<3>::Zero();
    for (const NodeIndex node : nodes) centre += x[node] / static_cast<double>(n);
    for (std::size_t k = 0; k < n; ++k)
      triangles.push_back({centre, x[nodes[k]], x[nodes[k + 1 < n ? k + 1 : 0]], patches[f]});
  }
  return triangles;
}

std::vector<Piece> segments_of(const SurfaceFeatures& features, std::span<const Point<3>> x) {
  std::vector<Piece> segments;
  for (std::size_t e = 0; e < features.feature_edges.size(); ++e) {
    const auto [a, b] = features.feature_edges[e];
    if (const NodeIndex middle = features.edge_middles[e]; middle != no_corner) {
      segments.push_back(curved_piece(std::array{a, b, middle}, x, features.edge_lines[e]));
      continue;
    }
    segments.push_back({x[a], x[b], x[b], features.edge_lines[e]});
  }
  return segments;
}

/// Smallest radius of a first search, relative to the surface: above rounding.
constexpr double min_radius = 1e-10;
constexpr std::size_t facet_grain = 256;  ///< facets that one thread checks at a time

/// Returns the midpoints of a facet and of its sides.
std::vector<Point<3>> middles(std::span<const NodeIndex> nodes, std::span<const Point<3>> x) {
  const std::size_t n = nodes.size();
  std::vector<Point<3>> points;
  points.reserve(n + 1);
  points.emplace_back(Point<3>::Zero());
  for (std::size_t k = 0; k < n; ++k) {
    points.front() += x[nodes[k]] / static_cast<double>(n);
    points.emplace_back(0.5 * (x[nodes[k]] + x[nodes[k + 1 < n ? k + 1 : 0]]));
  }
  return points;
}

}  // namespace

SurfaceConstraints::SurfaceConstraints(const SurfaceFacets& facets,
                                       std::span<const Point<3>> coordinates,
                                       const FeatureParameters& parameters, double facet_bound)
    : features_(find_features(facets, coordinates, parameters)),
      facets_(facets.nodes),
      node_facets_(facet_bound < unbounded ? rows_by_entry(facets.nodes, coordinates.size())
                                           : CompressedRows<std::uint32_t>()),
      facet_bound_(facet_bound),
      triangles_(
          std::make_unique<PieceIndex>(triangles_of(facets, coordinates, features_.facet_patches))),
      segments_(std::make_unique<PieceIndex>(segments_of(features_, coordinates))) {
  for (std::size_t f = 0; f < facets.nodes.size(); ++f)
    facet_normals_.push_back(facet_normal(facets.nodes[f], coordinates));
}
SurfaceConstraints::~SurfaceConstraints() = default;

Point<3> SurfaceConstraints::project(NodeIndex node, const Point<3>& from,
                                     const Point<3>& wanted) const {
  const GeometricClassification node_class = features_.classifications[node];
  if (node_class.kind == GeometricClassification::none || wanted == from) return wanted;
  if (node_class.kind == GeometricClassification::corner) return from;
  const PieceIndex& index =
      node_class.kind == GeometricClassification::patch ? *triangles_ : *segments_;
  const double radius = (wanted - from).norm() + min_radius * triangles_->extent();
  return index.nearest(wanted, node_class.part, radius);
}

double SurfaceConstraints::distance(const Point<3>& point) const {
  return distance(point, min_radius * triangles_->extent());
}

double SurfaceConstraints::distance(const Point<3>& point, double radius) const {
  return (triangles_->nearest(point, std::nullopt, radius) - point).norm();
}

double SurfaceConstraints::facet_distance(std::span<const Point<3>> coordinates) const {
  const double radius = facet_bound_ < unbounded ? facet_bound_ : min_radius * triangles_->extent();
  std::vector<double> of_facet(facets_.size(), 0.0);
  parallel_for_ranges(facets_.size(), facet_grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t f = first; f < last; ++f)
      for (const Point<3>& point : middles(facets_[f], coordinates))
        of_facet[f] = std::max(of_facet[f], distance(point, radius));
  });
  return of_facet.empty() ? 0.0 : *std::max_element(of_facet.begin(), of_facet.end());
}

bool SurfaceConstraints::is_out_of_bound(std::uint32_t facet,
                                         std::span<const Point<3>> coordinates) const {
  const auto points = middles(facets_[facet], coordinates);
  return std::any_of(points.begin(), points.end(), [&](const Point<3>& point) {
    return !(distance(point, facet_bound_) <= facet_bound_);
  });
}

std::vector<std::uint32_t> SurfaceConstraints::facets_out_of_bound(
    std::span<const Point<3>> coordinates) const {
  if (facet_bound_ == unbounded) return {};
  std::vector<std::uint8_t> is_out(facets_.size());
  parallel_for_ranges(facets_.size(), facet_grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t f = first; f < last; ++f)
      is_out[f] = is_out_of_bound(static_cast<std::uint32_t>(f), coordinates);
  });
  std::vector<std::uint32_t> found;
  for (std::uint32_t f = 0; f < is_out.size(); ++f)
    if (is_out[f]) found.push_back(f);
  return found;
}

std::vector<std::uint32_t> SurfaceConstraints::facets_of(std::span<const NodeIndex> around) const {
  if (facet_bound_ == unbounded) return {};
  std::vector<std::uint32_t> facets;
  for (const NodeIndex node : around)
    facets.insert(facets.end(), node_facets_[node].begin(), node_facets_[node].end());
  std::sort(facets.begin(), facets.end());
  facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
  return facets;
}

std::vector<std::uint32_t> SurfaceConstraints::facets_out_of_bound(
    std::span<const Point<3>> coordinates, std::span<const NodeIndex> around) const {
  auto facets = facets_of(around);
  std::erase_if(facets, [&](std::uint32_t f) { return !is_out_of_bound(f, coordinates); });
  return facets;
}

bool SurfaceConstraints::keeps_bound(std::span<const Point<3>> coordinates,
                                     std::span<const NodeIndex> around) const {
  const auto facets = facets_of(around);
  return std::none_of(facets.begin(), facets.end(),
                      [&](std::uint32_t f) { return is_out_of_bound(f, coordinates); });
}

void require_slide_distance(double slide_distance) {
  if (!(slide_distance > 0.0))
    throw InputError("the slide distance is " + std::to_string(slide_distance) +
                     "; give a fraction of the boundary's mean edge length above 0");
}

SurfaceMesh make_surface_mesh(CompressedRows<NodeIndex> cells, std::vector<Point<3>> coordinates,
                              MeshLabels labels, std::optional<std::vector<bool>> fixed,
                              const FeatureParameters& parameters) {
  constexpr int dim = 2;
  const std::size_t n_nodes = coordinates.size();
  require_finite(coordinates);
  SurfaceFacets facets{Topology(dim, n_nodes, cells).cells(), labels.cell_tags, {}};
  for (std::size_t f = 0; f < labels.facets.size(); ++f)
    facets.marked_edges.push_back({labels.facets[f][0], labels.facets[f][1]});
  auto constraints = std::make_shared<const SurfaceConstraints>(facets, coordinates, parameters);
  std::vector<FixedReasons> reasons(n_nodes, 0);
  for (NodeIndex i = 0; i < n_nodes; ++i)
    if (constraints->is_corner(i)) reasons[i] |= bit(FixedReason::corner);
  auto topology =
      std::make_shared<const Topology>(dim, n_nodes, std::move(cells), reasons, std::move(labels));
  add_implied_reasons(*topology, reasons);
  if (fixed) add_marks(*fixed, reasons);
  for (NodeIndex i = 0; i < n_nodes; ++i)
    reasons[i] |=
        topology->fixed_reasons(i) & (bit(FixedReason::unused) | bit(FixedReason::midside));
  if (reasons != topology->fixed_reasons())
    topology = std::make_shared<const Topology>(dim, n_nodes, topology->cells(), std::move(reasons),
                                                topology->labels());
  return {std::move(topology), std::move(coordinates), std::move(constraints)};
}

SurfaceMesh with_features(const SurfaceMesh& mesh, const FeatureParameters& parameters) {
  const Topology& topology = mesh.topology();
  std::vector<bool> fixed(mesh.n_nodes());
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    fixed[i] = has(topology.fixed_reasons(i), FixedReason::marked);
  return make_surface_mesh(topology.cells(), mesh.copied_coordinates(), topology.labels(),
                           std::move(fixed), parameters);
}

}  // namespace smoothfem
