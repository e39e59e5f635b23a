#include "smoothing/surface/node_constraints.h"

#include <array>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>
#include <limits>
#include <optional>

#include "smoothing/surface/nearest_point.h"

namespace smoothfem {

namespace {

namespace bg = boost::geometry;
namespace bgi = boost::geometry::index;
using Corner = bg::model::point<double, 3, bg::cs::cartesian>;
using Box = bg::model::box<Corner>;

Box box_between(const Point<3>& low, const Point<3>& high) {
  return {Corner(low.x(), low.y(), low.z()), Corner(high.x(), high.y(), high.z())};
}

/// A triangle of a smooth part, or a segment (c = b) of a feature line.
struct Piece {
  Point<3> a, b, c;
  std::uint32_t part;

  Point<3> nearest(const Point<3>& p) const {
    return c == b ? nearest_on_segment(p, a, b) : nearest_on_triangle(p, a, b, c);
  }
  Box box() const { return box_between(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)); }
};

std::vector<Piece> triangles_of(const SurfaceFacets& facets, const std::vector<Point<3>>& x,
                                const std::vector<std::uint32_t>& patches) {
  std::vector<Piece> triangles;
  for (std::uint32_t f = 0; f < facets.nodes.size(); ++f) {
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

std::vector<Piece> segments_of(const SurfaceFeatures& features, const std::vector<Point<3>>& x) {
  std::vector<Piece> segments;
  for (std::size_t e = 0; e < features.feature_edges.size(); ++e) {
    const auto [a, b] = features.feature_edges[e];
    segments.push_back({x[a], x[b], x[b], features.edge_lines[e]});
  }
  return segments;
}

}  // namespace

/// Pieces, found by their boxes. Boost's R-tree rather than VTK's locator: it needs no more than
/// headers, and it lets the pieces of other parts of the surface be left out.
class NodeConstraints::Index {
 public:
  explicit Index(std::vector<Piece> pieces) : pieces_(std::move(pieces)), tree_(entries()) {}

  /// Nearest point to p on the pieces of a part, or of all of them. Every piece within `radius`
  /// meets the box of that size; where none is as near, a larger box is taken.
  Point<3> nearest(const Point<3>& p, std::optional<std::uint32_t> part, double radius) const {
    Point<3> best = p;
    for (double best_square = infinite; best_square > radius * radius; radius *= 2.0) {
      best_square = infinite;
      std::uint32_t best_piece = 0;
      const auto look_at = [&](const Entry& entry) {
        const Piece& piece = pieces_[entry.second];
        if (part && piece.part != *part) return;
        const Point<3> point = piece.nearest(p);
        const double square = (point - p).squaredNorm();
        const bool tie = square == best_square && entry.second < best_piece;
        if (!(square < best_square || tie)) return;
        best = point;
        best_square = square;
        best_piece = entry.second;
      };
      const Point<3> half = Point<3>::Constant(radius);
      tree_.query(bgi::intersects(box_between(p - half, p + half)),
                  boost::make_function_output_iterator(std::ref(look_at)));
    }
    return best;
  }

  /// Longest side of the box around all pieces.
  double extent() const {
    const Box box = tree_.bounds();
    return std::max({bg::get<bg::max_corner, 0>(box) - bg::get<bg::min_corner, 0>(box),
                     bg::get<bg::max_corner, 1>(box) - bg::get<bg::min_corner, 1>(box),
                     bg::get<bg::max_corner, 2>(box) - bg::get<bg::min_corner, 2>(box)});
  }

 private:
  using Entry = std::pair<Box, std::uint32_t>;
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  std::vector<Entry> entries() const {
    std::vector<Entry> all;
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) all.emplace_back(pieces_[i].box(), i);
    return all;
  }

  std::vector<Piece> pieces_;
  bgi::rtree<Entry, bgi::rstar<16>> tree_;
};

namespace {

/// Smallest radius to begin a search with, relative to the surface: above rounding.
constexpr double least_radius = 1e-10;

}  // namespace

NodeConstraints::NodeConstraints(const SurfaceFacets& facets, std::vector<Point<3>> coordinates,
                                 const FeatureParameters& parameters)
    : features_(find_features(facets, coordinates, parameters)),
      triangles_(
          std::make_unique<Index>(triangles_of(facets, coordinates, features_.facet_patches))),
      segments_(std::make_unique<Index>(segments_of(features_, coordinates))) {
  for (std::size_t f = 0; f < facets.nodes.size(); ++f)
    facet_normals_.push_back(area_vector(facets.nodes[f], coordinates).normalized());
}
NodeConstraints::~NodeConstraints() = default;

Point<3> NodeConstraints::project(NodeIndex node, const Point<3>& from,
                                  const Point<3>& wanted) const {
  const NodeCarrier carrier = features_.carriers[node];
  if (carrier.kind == NodeCarrier::none || wanted == from) return wanted;
  if (carrier.kind == NodeCarrier::corner) return from;
  const Index& index = carrier.kind == NodeCarrier::patch ? *triangles_ : *segments_;
  const double radius = (wanted - from).norm() + least_radius * triangles_->extent();
  return index.nearest(wanted, carrier.part, radius);
}

double NodeConstraints::distance(const Point<3>& point) const {
  const double extent = triangles_->extent();
  return (triangles_->nearest(point, std::nullopt, least_radius * extent) - point).norm();
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
  auto constraints = std::make_shared<const NodeConstraints>(facets, coordinates, parameters);
  std::vector<bool> stays = fixed ? std::move(*fixed) : std::vector<bool>(n_nodes, false);
  for (NodeIndex i = 0; i < n_nodes; ++i)
    if (constraints->is_corner(i)) stays[i] = true;
  return {std::make_shared<const Topology>(dim, n_nodes, std::move(cells), std::move(stays),
                                           std::move(labels)),
          std::move(coordinates), std::move(constraints)};
}

SurfaceMesh with_features(const SurfaceMesh& mesh, const FeatureParameters& parameters) {
  const Topology& topology = mesh.topology();
  std::vector<bool> fixed(mesh.n_nodes());
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    fixed[i] = topology.is_fixed(i) && !mesh.constraints()->is_corner(i);
  return make_surface_mesh(topology.cells(), mesh.coordinates(), topology.labels(),
                           std::move(fixed), parameters);
}

}  // namespace smoothfem
