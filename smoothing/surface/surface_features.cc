// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/surface/surface_features.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>

#include "smoothing/geometry/cell_size.h"
#include "smoothing/surface/quadratic_piece.h"

namespace smoothfem {

namespace {

using Edge = std::array<NodeIndex, 2>;

Edge sorted_edge(NodeIndex a, NodeIndex b) {
  return {std::min(a, b), std::max(a, b)};
}

/// A side of a facet.
struct Side {
  Edge edge;
  std::uint32_t facet;
  std::uint32_t position;  ///< in the facet
  bool reversed;           ///< runs from the higher node to the lower one

  bool operator<(const Side& other) const {
    return std::tie(edge, facet) < std::tie(other.edge, other.facet);
  }
};

std::vector<Side> sides_of(const CompressedRows<NodeIndex>& facets) {
  std::vector<Side> sides;
  sides.reserve(facets.n_entries());
  for (std::uint32_t f = 0; f < facets.size(); ++f)
    for (std::uint32_t k = 0; k < facets[f].size(); ++k) {
      const NodeIndex a = facets[f][k], b = facets[f][k + 1 < facets[f].size() ? k + 1 : 0];
      sides.push_back({sorted_edge(a, b), f, k, a > b});
    }
  std::sort(sides.begin(), sides.end());
  return sides;
}

/// Union of elements into groups. At the end each group gets a number, by first member.
class Groups {
 public:
  explicit Groups(std::size_t n) : parents_(n) {
    std::iota(parents_.begin(), parents_.end(), std::uint32_t{0});
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::uint32_t> numbers() {
    std::vector<std::uint32_t> result(parents_.size());
    std::uint32_t n = 0;
    for (std::uint32_t i = 0; i < result.size(); ++i)
      result[i] = root(i) == i ? n++ : result[root(i)];
    return result;
  }

 private:
  std::uint32_t root(std::uint32_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  std::vector<std::uint32_t> parents_;
};

class FeatureSearch {
 public:
  FeatureSearch(const SurfaceFacets& facets, std::span<const Point<3>> coordinates,
                double angle_degrees)
      : facets_(facets),
        x_(coordinates),
        cosine_(std::cos(angle_degrees * std::numbers::pi / 180.0)) {
    for (std::uint32_t f = 0; f < facets.nodes.size(); ++f)
      normals_.push_back(facet_normal(facets.nodes[f], coordinates));
    for (std::uint32_t f = 0; f < facets.midside.size(); ++f) add_curved_sides(f);
  }

  SurfaceFeatures find() {
    find_edges_and_patches();
    find_lines_and_classify_nodes();
    return std::move(result_);
  }

 private:
  /// Sets the normals and the midside nodes of a facet's sides, if it is curved.
  void add_curved_sides(std::uint32_t facet) {
    const auto nodes = facets_.curved_nodes(facet);
    std::vector<Point<3>> points, normals;
    for (const NodeIndex node : nodes) points.push_back(x_[node]);
    if (!nodes.empty()) {
      const QuadraticPiece piece(points);
      const std::size_t n = facets_.nodes[facet].size();
      for (std::size_t k = 0; k < n; ++k) {
        middles_[sorted_edge(nodes[k], nodes[(k + 1) % n])] = nodes[n + k];
        normals.push_back(piece.normal_at_side(k));
      }
    }
    side_normals_.append(normals);
  }

  bool is_feature(std::span<const Side> sides) const {
    if (sides.size() != 2) return true;
    const auto a = sides[0].facet, b = sides[1].facet;
    if (sides[0].reversed == sides[1].reversed)
      throw InputError("facets " + std::to_string(a) + " and " + std::to_string(b) +
                       " of the surface run along their common edge, nodes " +
                       std::to_string(sides[0].edge[0]) + " and " +
                       std::to_string(sides[0].edge[1]) +
                       ", in the same direction; orient all facets alike");
    if (!facets_.tags.empty() && facets_.tags[a] != facets_.tags[b]) return true;
    if (std::binary_search(marked_.begin(), marked_.end(), sides[0].edge)) return true;
    return normal_at(sides[0]).dot(normal_at(sides[1])) < cosine_;
  }

  /// Returns the unit normal of a facet, of a curved one in the middle of a side.
  const Point<3>& normal_at(const Side& side) const {
    const bool is_curved = side_normals_.size() > 0 && !side_normals_[side.facet].empty();
    return is_curved ? side_normals_[side.facet][side.position] : normals_[side.facet];
  }

  NodeIndex middle_of(const Edge& edge) const {
    const auto found = middles_.find(edge);
    return found == middles_.end() ? no_corner : found->second;
  }

  void find_edges_and_patches() {
    for (const Edge& edge : facets_.marked_edges) marked_.push_back(sorted_edge(edge[0], edge[1]));
    std::sort(marked_.begin(), marked_.end());
    const auto sides = sides_of(facets_.nodes);
    Groups patches(facets_.nodes.size());
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
      while (last < sides.size() && sides[last].edge == sides[first].edge) ++last;
      if (is_feature({sides.data() + first, last - first}))
        result_.feature_edges.push_back(sides[first].edge);
      else
        patches.join(sides[first].facet, sides[first + 1].facet);
    }
    result_.facet_patches = patches.numbers();
  }

  /// Classifies nodes: those of a single smooth part, of two feature edges that continue nearly
  /// straight, and the rest.
  void find_lines_and_classify_nodes() {
    const auto& edges = result_.feature_edges;
    auto& nodes = result_.classifications;
    nodes.resize(x_.size());
    for (std::uint32_t f = 0; f < facets_.nodes.size(); ++f)
      for (const NodeIndex i : facets_.nodes[f]) {
        const std::uint32_t patch = result_.facet_patches[f];
        if (nodes[i].kind == GeometricClassification::none)
          nodes[i] = {GeometricClassification::patch, patch};
        else if (nodes[i].part != patch)
          nodes[i].kind = GeometricClassification::corner;  // unless it turns out to be on a line
      }
    std::vector<std::vector<std::uint32_t>> edges_at(x_.size());
    for (std::uint32_t e = 0; e < edges.size(); ++e)
      for (const NodeIndex i : edges[e]) edges_at[i].push_back(e);
    Groups lines(edges.size());
    for (NodeIndex i = 0; i < x_.size(); ++i) {
      if (edges_at[i].empty()) continue;
      nodes[i].kind = continues_straight(i, edges_at[i]) ? GeometricClassification::line
                                                         : GeometricClassification::corner;
      if (nodes[i].kind == GeometricClassification::line)
        lines.join(edges_at[i][0], edges_at[i][1]);
    }
    result_.edge_lines = lines.numbers();
    for (NodeIndex i = 0; i < x_.size(); ++i)
      if (nodes[i].kind == GeometricClassification::line)
        nodes[i].part = result_.edge_lines[edges_at[i][0]];
    classify_midside_nodes();
  }

  void classify_midside_nodes() {
    auto& nodes = result_.classifications;
    for (std::uint32_t f = 0; f < facets_.midside.size(); ++f)
      for (const NodeIndex i : facets_.midside[f])
        if (i != no_corner) nodes[i] = {GeometricClassification::patch, result_.facet_patches[f]};
    for (std::uint32_t e = 0; e < result_.feature_edges.size(); ++e) {
      const NodeIndex middle = middle_of(result_.feature_edges[e]);
      result_.edge_middles.push_back(middle);
      if (middle != no_corner)
        nodes[middle] = {GeometricClassification::line, result_.edge_lines[e]};
    }
  }

  bool continues_straight(NodeIndex node, const std::vector<std::uint32_t>& edges) const {
    if (edges.size() != 2) return false;
    const auto direction_to_other_end = [&](std::uint32_t e) {
      const Edge& edge = result_.feature_edges[e];
      const Point<3> to_end = x_[edge[0] == node ? edge[1] : edge[0]] - x_[node];
      const NodeIndex middle = middle_of(edge);
      if (middle == no_corner) return Point<3>(to_end.normalized());
      return Point<3>((4.0 * (x_[middle] - x_[node]) - to_end).normalized());
    };
    return -direction_to_other_end(edges[0]).dot(direction_to_other_end(edges[1])) >= cosine_;
  }

  const SurfaceFacets& facets_;
  std::span<const Point<3>> x_;
  double cosine_;
  std::vector<Point<3>> normals_;
  CompressedRows<Point<3>> side_normals_;  ///< of each facet; empty rows, or none, for linear ones
  std::map<Edge, NodeIndex> middles_;
  std::vector<Edge> marked_;
  SurfaceFeatures result_;
};

}  // namespace

SurfaceFeatures find_features(const SurfaceFacets& facets, std::span<const Point<3>> coordinates,
                              const FeatureParameters& parameters) {
  if (!(parameters.angle_degrees > 0.0 && parameters.angle_degrees <= 180.0))
    throw InputError("the feature angle is " + std::to_string(parameters.angle_degrees) +
                     " degrees; give one above 0, at most 180");
  return FeatureSearch(facets, coordinates, parameters.angle_degrees).find();
}

}  // namespace smoothfem
