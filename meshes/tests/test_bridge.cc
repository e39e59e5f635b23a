// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tests/domain_tests.h"

namespace smoothfem {
namespace {

/// In metres: the section's corners by the shoelace formula, less round ducts.
constexpr double box_area =
    0.5 * ((2.25 + 2.75) * 2 * 1.9 + (2.75 + 5.5) * 2 * 0.2 + 11.0 * 2 * 0.3);
constexpr double cell_area = 0.5 * ((1.85 + 2.25) * 2 * 1.45 + (2.25 + 1.85) * 2 * 0.2);
constexpr double section_area = box_area - cell_area - 4 * 3.14159265 * 0.09 * 0.09;

void expect_box_girder(const VolumeMesh& mesh) {
  expect_valid(mesh);
  EXPECT_EQ(euler_characteristic(mesh), 1 - 5) << "the box's cell and four ducts";
  EXPECT_NEAR(volume_inside(mesh), 8.2 * section_area, 0.01 * 8.2 * section_area);
}

TEST(Bridge, HexahedraHaveTheCountsOfTheThesis) {
  const VolumeMesh mesh = mesh_of_domain<3>("bridge", {.elements = "hexahedra"});
  expect_box_girder(mesh);
  EXPECT_EQ(mesh.n_nodes(), 307530u);
  EXPECT_EQ(mesh.n_cells(), 260496u);
  EXPECT_GT(mesh_quality(mesh).q_mean, 0.91);
}

TEST(Bridge, TetrahedraHaveTheCountsOfTheThesis) {
  SKIP_UNLESS_LONG();
  const VolumeMesh mesh = mesh_of_domain<3>("bridge", {.elements = "tetrahedra"});
  expect_box_girder(mesh);
  EXPECT_NEAR(static_cast<double>(mesh.n_nodes()), 53978, 0.02 * 53978);
  EXPECT_NEAR(static_cast<double>(mesh.n_cells()), 262201, 0.02 * 262201);
  EXPECT_GT(mesh_quality(mesh).q_mean, 0.83);
}

TEST(Bridge, CanBeCoarserAndIsTheSameEveryTime) {
  for (const std::string elements : {"tetrahedra", "hexahedra"})
    for (const double scale : test::short_or_long({2.0}, {1.5, 2.0})) {
      const DomainParameters parameters{elements, scale, 1};
      const VolumeMesh mesh = mesh_of_domain<3>("bridge", parameters);
      expect_box_girder(mesh);
      EXPECT_LT(mesh.n_cells(), 262201 / (scale * scale));
      expect_same_mesh(mesh, mesh_of_domain<3>("bridge", parameters));
    }
  expect_edge_scales("bridge", 2);
  EXPECT_THAT(input_error_of([] { mesh_of_domain<3>("bridge", {.elements = "mixed"}); }),
              ::testing::HasSubstr("choose one of tetrahedra, hexahedra"));
}

}  // namespace
}  // namespace smoothfem
