// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/triangulation_edits.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "meshes/distortion/counter_random.h"
#include "smoothing/quality/mean_ratio.h"

namespace smoothfem {

namespace {

constexpr std::uint32_t outside = UINT32_MAX;

/// Triangles with their neighbours: neighbour k lies across the edge opposite corner k.
class Triangulation {
 public:
  using Triangle = std::array<NodeIndex, 3>;

  explicit Triangulation(const PlanarCells& mesh) : coordinates_(mesh.coordinates) {
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      triangles_.push_back({mesh.cells[c][0], mesh.cells[c][1], mesh.cells[c][2]});
    connect();
  }

  PlanarCells cells() const {
    PlanarCells mesh{coordinates_, {}};
    for (const auto& triangle : triangles_) mesh.cells.append(triangle);
    return mesh;
  }

  std::size_t size() const { return triangles_.size(); }

  /// Splits the longest inner edges, at most one per triangle and at most n_splits.
  void split_longest(std::size_t n_splits) {
    struct InnerEdge {
      double squared_length;
      std::uint32_t triangle, corner;
    };
    std::vector<InnerEdge> edges;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k)
        if (neighbours_[t][k] != outside && t < neighbours_[t][k])
          edges.push_back({(corner(t, k + 1) - corner(t, k + 2)).squaredNorm(), t, k});
    std::sort(edges.begin(), edges.end(), [](const InnerEdge& a, const InnerEdge& b) {
      return std::tie(b.squared_length, a.triangle, a.corner) <
             std::tie(a.squared_length, b.triangle, b.corner);
    });
    std::vector<bool> touched(triangles_.size(), false);
    for (const auto& edge : edges) {
      const std::uint32_t t = edge.triangle, u = neighbours_[t][edge.corner];
      if (n_splits == 0) break;
      if (touched[t] || touched[u]) continue;
      touched[t] = touched[u] = true;
      --n_splits;
      split(t, edge.corner);
    }
    connect();
  }

  /// Flips the edge opposite corner k of triangle t if that is allowed.
  bool flip(std::uint32_t t, std::uint32_t k) {
    const std::uint32_t u = neighbours_[t][k];
    if (u == outside) return false;
    const std::uint32_t m = opposite_corner(u, t);
    const NodeIndex c = triangles_[t][k], a = triangles_[t][(k + 1) % 3];
    const NodeIndex b = triangles_[t][(k + 2) % 3], d = triangles_[u][m];
    if (!may_lose_edge(a, b) || !may_gain_edge(c, d)) return false;
    if (!is_counterclockwise(a, d, c) || !is_counterclockwise(d, b, c)) return false;
    const std::uint32_t beyond_bc = neighbours_[t][(k + 1) % 3];
    const std::uint32_t beyond_ca = neighbours_[t][(k + 2) % 3];
    const std::uint32_t beyond_ad = neighbours_[u][(m + 1) % 3];
    const std::uint32_t beyond_db = neighbours_[u][(m + 2) % 3];
    triangles_[t] = {a, d, c};
    neighbours_[t] = {u, beyond_ca, beyond_ad};
    triangles_[u] = {d, b, c};
    neighbours_[u] = {beyond_bc, t, beyond_db};
    replace_neighbour(beyond_ad, u, t);
    replace_neighbour(beyond_bc, t, u);
    --n_edges_[a], --n_edges_[b], ++n_edges_[c], ++n_edges_[d];
    return true;
  }

 private:
  void connect() {
    std::map<std::pair<NodeIndex, NodeIndex>, std::pair<std::uint32_t, std::uint32_t>> open;
    neighbours_.assign(triangles_.size(), {outside, outside, outside});
    n_edges_.assign(coordinates_.size(), 0);
    on_boundary_.assign(coordinates_.size(), false);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const NodeIndex from = triangles_[t][(k + 1) % 3], to = triangles_[t][(k + 2) % 3];
        const auto other = open.find({to, from});
        if (other == open.end()) {
          open[{from, to}] = {t, k};
          ++n_edges_[from], ++n_edges_[to];
          continue;
        }
        neighbours_[t][k] = other->second.first;
        neighbours_[other->second.first][other->second.second] = t;
        open.erase(other);
      }
    for (const auto& [edge, _] : open) on_boundary_[edge.first] = on_boundary_[edge.second] = true;
  }

  const Point<2>& corner(std::uint32_t t, std::uint32_t k) const {
    return coordinates_[triangles_[t][k % 3]];
  }

  std::uint32_t opposite_corner(std::uint32_t t, std::uint32_t neighbour) const {
    const auto& row = neighbours_[t];
    return static_cast<std::uint32_t>(std::find(row.begin(), row.end(), neighbour) - row.begin());
  }

  void replace_neighbour(std::uint32_t t, std::uint32_t from, std::uint32_t to) {
    if (t != outside) neighbours_[t][opposite_corner(t, from)] = to;
  }

  bool may_lose_edge(NodeIndex a, NodeIndex b) const {
    constexpr int fewest = 3;
    if (on_boundary_[a] && on_boundary_[b]) return false;
    return (on_boundary_[a] || n_edges_[a] > fewest) && (on_boundary_[b] || n_edges_[b] > fewest);
  }

  bool may_gain_edge(NodeIndex c, NodeIndex d) const {
    constexpr int most = 9;
    if (on_boundary_[c] && on_boundary_[d]) return false;
    return n_edges_[c] < most && n_edges_[d] < most;
  }

  /// Requires a margin, so that no flip makes a triangle that rounding could turn over.
  bool is_counterclockwise(NodeIndex a, NodeIndex b, NodeIndex c) const {
    constexpr double min_quality = 1e-3;
    const std::array corners{vector_of(coordinates_[a]), vector_of(coordinates_[b]),
                             vector_of(coordinates_[c])};
    return mean_ratio(std::span<const Vector2<double>, 3>(corners)) > min_quality;
  }

  /// Leaves neighbours_ outdated: call connect() afterwards.
  void split(std::uint32_t t, std::uint32_t k) {
    const std::uint32_t u = neighbours_[t][k], m = opposite_corner(u, t);
    const NodeIndex c = triangles_[t][k], a = triangles_[t][(k + 1) % 3];
    const NodeIndex b = triangles_[t][(k + 2) % 3], d = triangles_[u][m];
    const auto middle = static_cast<NodeIndex>(coordinates_.size());
    coordinates_.push_back(0.5 * (coordinates_[a] + coordinates_[b]));
    triangles_[t] = {a, middle, c};
    triangles_[u] = {b, middle, d};
    triangles_.push_back({middle, b, c});
    triangles_.push_back({middle, a, d});
  }

  std::vector<Point<2>> coordinates_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  std::vector<int> n_edges_;
  std::vector<bool> on_boundary_;
};

}  // namespace

void refine_to(PlanarCells& mesh, std::size_t n_cells) {
  Triangulation triangulation(mesh);
  while (triangulation.size() + 2 <= n_cells) {
    const std::size_t before = triangulation.size();
    triangulation.split_longest((n_cells - before) / 2);
    if (triangulation.size() == before) break;  // a mesh without inner edges
  }
  mesh = triangulation.cells();
}

std::size_t flip_edges(PlanarCells& mesh, std::size_t n_flips, std::uint64_t seed) {
  constexpr std::size_t tries_per_flip = 100;
  Triangulation triangulation(mesh);
  SplitMix64 random = counter_random(seed, 0, 0);
  std::size_t n_done = 0;
  for (std::size_t i = 0; n_done < n_flips && i < tries_per_flip * n_flips; ++i) {
    const auto triangle = static_cast<std::uint32_t>(random.below(triangulation.size()));
    const auto corner = static_cast<std::uint32_t>(random.below(3));
    if (triangulation.flip(triangle, corner)) ++n_done;
  }
  mesh = triangulation.cells();
  return n_done;
}

}  // namespace smoothfem
