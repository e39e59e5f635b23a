// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "meshes/tests/domain_tests.h"
#include "smoothing/quality/mean_ratio.h"

namespace smoothfem {
namespace {

std::size_t count(const VolumeMesh& mesh, ElementType type) {
  std::size_t n = 0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) n += mesh.topology().cell_type(c) == type;
  return n;
}

void expect_counts(const VolumeMesh& mesh,
                   const std::vector<std::pair<ElementType, double>>& counts, double tolerance) {
  for (const auto& [type, n] : counts)
    EXPECT_NEAR(static_cast<double>(count(mesh, type)), n, tolerance * n) << name_of(type);
}

/// Expects q_min within a factor of 2 of the printed value, and q_mean within 0.01.
void expect_qualities(const VolumeMesh& mesh, double q_min, double q_mean) {
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_GE(quality.q_min, 0.5 * q_min);
  EXPECT_LE(quality.q_min, 2.0 * q_min);
  EXPECT_NEAR(quality.q_mean, q_mean, 0.01);
}

TEST(Ring, HasTheCountsOfTheThesis) {
  const VolumeMesh mesh = mesh_of_domain<3>("ring");
  expect_valid(mesh);
  expect_counts(mesh,
                {{ElementType::tetrahedron, 74106},
                 {ElementType::hexahedron, 7486},
                 {ElementType::pyramid, 1618}},
                0.02);
  EXPECT_EQ(euler_characteristic(mesh), 1) << "a cuboid (1) without a solid torus (0)";
  EXPECT_EQ(mesh.topology().boundary_facets().size(), 5226u + 2u * (24 * 25 + 24 * 16 + 25 * 16));
  expect_edge_scales("ring", 1);
}

TEST(Plate, HasTheCountsAndTheQualityOfTheThesis) {
  const VolumeMesh mesh = mesh_of_domain<3>("plate");
  expect_valid(mesh);
  expect_counts(mesh,
                {{ElementType::tetrahedron, 26082},
                 {ElementType::pyramid, 2220},
                 {ElementType::hexahedron, 5748}},
                0.05);
  expect_qualities(mesh, 0.1625, 0.7302);
  EXPECT_EQ(euler_characteristic(mesh), 1) << "nothing is empty inside the cuboid";
  EXPECT_NEAR(volume_inside(mesh), 18.0 * 12.0 * 10.0, 1e-9);
  expect_edge_scales("plate", 1);
}

TEST(Aorta, HasTheCountsAndTheQualityOfTheThesis) {
  const VolumeMesh mesh = mesh_of_domain<3>("aorta");
  expect_valid(mesh);
  expect_counts(mesh, {{ElementType::prism, 80724}}, 0.02);
  expect_counts(mesh, {{ElementType::tetrahedron, 35551}}, 0.05);
  EXPECT_EQ(euler_characteristic(mesh), 1);
  EXPECT_EQ(count(mesh, ElementType::prism) % 6, 0u) << "six layers";
  double sum = 0.0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    if (mesh.topology().cell_type(c) == ElementType::prism) sum += cell_mean_ratio(mesh, c);
  EXPECT_NEAR(sum / static_cast<double>(count(mesh, ElementType::prism)), 0.0866, 0.005)
      << "thin as in the thesis";
  expect_qualities(mesh, 0.0413, 0.3077);
  expect_edge_scales("aorta", 1);
}

/// Returns the largest angle in degrees between the normals of neighbouring boundary triangles.
/// Takes those whose common edge has its middle between two heights.
double sharpest_bend(const VolumeMesh& mesh, double from, double to) {
  const auto& facets = mesh.topology().boundary_facets();
  const auto x = mesh.copied_coordinates();
  std::map<std::pair<NodeIndex, NodeIndex>, Point<3>> first;
  double least_cosine = 1.0;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto t = facets[f];
    const Point<3> normal = (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto edge = std::minmax(t[k], t[(k + 1) % 3]);
      const auto [other, is_new] = first.emplace(edge, normal);
      const double height = 0.5 * (x[edge.first].y() + x[edge.second].y());
      if (!is_new && height > from && height < to)
        least_cosine = std::min(least_cosine, other->second.dot(normal));
    }
  }
  return std::acos(least_cosine) * 180.0 / std::numbers::pi;
}

TEST(Aorta, HasBranchesWithoutCreases) {
  const VolumeMesh mesh = mesh_of_domain<3>("aorta");
  EXPECT_LT(sharpest_bend(mesh, 10.0, 30.0), 40.0) << "at the branches; round parts bend by 22";
  EXPECT_GT(sharpest_bend(mesh, -1e9, -55.0), 80.0) << "at the rim of the lower end";
}

TEST(EmbeddedDomains, AreTheSameEveryTime) {
  // The aorta and the plate have one size only.
  std::vector<std::string> names{"ring"};
  if (test::is_long()) names.insert(names.end(), {"plate", "aorta"});
  for (const auto& domain : names)
    expect_same_mesh(mesh_of_domain<3>(domain), mesh_of_domain<3>(domain));
}

}  // namespace
}  // namespace smoothfem
