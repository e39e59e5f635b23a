// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <map>

#include "meshes/distortion/counter_random.h"
#include "meshes/domains/catalogue.h"
#include "meshes/tools/delaunay.h"
#include "meshes/tools/unit_vector.h"

namespace smoothfem {
namespace {

constexpr int n_divisions = 3;
constexpr std::size_t n_inner = 346;
/// Random displacement of the grid's nodes in each direction, in units of its spacing.
constexpr double disturbance = 0.5;

using Triangle = std::array<NodeIndex, 3>;

/// Returns nodes on the unit sphere: the octahedron's triangles, repeatedly divided into four.
std::vector<Point<3>> sphere_nodes() {
  std::vector<Point<3>> nodes{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<Triangle> triangles;
  for (const NodeIndex x : {0U, 1U})
    for (const NodeIndex y : {2U, 3U})
      for (const NodeIndex z : {4U, 5U}) triangles.push_back({x, y, z});
  for (int division = 0; division < n_divisions; ++division) {
    std::map<std::pair<NodeIndex, NodeIndex>, NodeIndex> middles;
    const auto middle = [&](NodeIndex a, NodeIndex b) {
      const auto [known, is_new] =
          middles.emplace(std::minmax(a, b), static_cast<NodeIndex>(nodes.size()));
      if (is_new) nodes.push_back(unit_vector(nodes[a] + nodes[b]));
      return known->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : triangles) {
      const NodeIndex ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  return nodes;
}

/// Returns the grid's nodes nearest to the centre, disturbed at random.
std::vector<Point<3>> inner_nodes(std::uint64_t seed) {
  // A ball of this radius, half a spacing below the surface, contains the wanted number of grid
  // nodes.
  constexpr int n = 6;
  constexpr double spacing = 0.188;
  std::vector<Point<3>> nodes;
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j)
      for (int k = -n; k <= n; ++k) nodes.emplace_back(i + 0.5, j + 0.25, k);
  std::stable_sort(nodes.begin(), nodes.end(),
                   [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
  nodes.resize(n_inner);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    SplitMix64 random = counter_random(seed, i, 0);
    for (auto& coordinate : nodes[i])
      coordinate = spacing * (coordinate + disturbance * (2.0 * random.uniform() - 1.0));
  }
  return nodes;
}

/// A ball of 258 surface nodes and 346 inner nodes, with their Delaunay tetrahedra (thesis, Section
/// 5.2.1). The surface nodes are those of an octahedron divided three times, the inner ones those
/// of a randomly disturbed grid. Flat tetrahedra lower its quality. Surface nodes are fixed. Throws
/// InputError if the edge scale is not 1.
AnyMesh generate(const DomainParameters& p) {
  require_edge_scale("sphere", p.edge_scale, 1);
  std::vector<Point<3>> nodes = sphere_nodes();
  const auto inner = inner_nodes(p.seed);
  nodes.insert(nodes.end(), inner.begin(), inner.end());
  const auto all = [](const Point<3>&, double) { return true; };
  return mesh_of(delaunay_mesh(std::move(nodes), "the ball", all), "generated ball");
}

const RegisteredDomain registered(
    {.name = "sphere",
     .description =
         "Section 5.2.1's ball: its 258 surface and 346 inner nodes, other random numbers",
     .dimension = 3,
     .elements = {"tetrahedra"},
     .random_elements = {"tetrahedra"},
     .make = generate});

}  // namespace
}  // namespace smoothfem
