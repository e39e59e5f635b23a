// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

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

TEST(Plate, HasNearlyTheCountsOfTheThesis) {
  const VolumeMesh mesh = mesh_of_domain<3>("plate");
  expect_valid(mesh);
  expect_counts(mesh, {{ElementType::tetrahedron, 26082}, {ElementType::pyramid, 2220}}, 0.15);
  expect_counts(mesh, {{ElementType::hexahedron, 5748}}, 0.02);
  EXPECT_EQ(euler_characteristic(mesh), 1) << "nothing is empty inside the cuboid";
  EXPECT_NEAR(volume_inside(mesh), 18.0 * 12.0 * 10.0, 1e-9);
  expect_edge_scales("plate", 1);
}

TEST(Aorta, HasTheCountsOfTheThesis) {
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
  expect_edge_scales("aorta", 1);
}

TEST(EmbeddedDomains, AreTheSameEveryTime) {
  for (const char* domain : {"ring", "plate", "aorta"})
    expect_same_mesh(mesh_of_domain<3>(domain), mesh_of_domain<3>(domain));
}

}  // namespace
}  // namespace smoothfem
