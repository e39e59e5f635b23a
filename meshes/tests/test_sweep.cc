// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tests/domain_tests.h"

namespace smoothfem {
namespace {

TEST(SweepMesh, HasTheCountsOfTheThesis) {
  const VolumeMesh mesh = mesh_of_domain<3>("sweep");
  expect_valid(mesh);
  EXPECT_EQ(mesh.n_nodes(), 14352u);
  EXPECT_EQ(mesh.n_cells(), 12255u);
  EXPECT_EQ(euler_characteristic(mesh), 1);
  const Adjacency cells = adjacency(mesh, 8);
  EXPECT_EQ(cells.least, 1u);
  EXPECT_EQ(cells.most, 12u);
  EXPECT_NEAR(cells.mean, 6.8, 0.05);
}

TEST(SweepMesh, IsTurnedAboutTheAxisY) {
  for (const double scale : {1.0, 1.5, 2.0, 3.0}) {
    const VolumeMesh mesh = mesh_of_domain<3>("sweep", {.edge_scale = scale});
    expect_valid(mesh);
    EXPECT_EQ(euler_characteristic(mesh), 1);
    for (const Point<3>& p : mesh.coordinates()) {
      const double r = std::hypot(p.x(), p.z()), angle = std::atan2(p.z(), p.x());
      ASSERT_GT(r, 0.5 - 1e-12);
      ASSERT_LT(r, 5.2 + 1e-12);
      ASSERT_GT(angle, -1e-12);
      ASSERT_LT(angle, 70.0 / 180.0 * 3.14159266);
    }
    // Guldin: area times the path of the centroid; flat facets instead of round ones change it
    // little.
    const double hub = 1.5 * 3.0, web = 2.0 * 1.8, rim = 1.2 * 4.0;
    const double moment = hub * 1.25 + web * 3.0 + rim * 4.6;
    const double whole = moment * 70.0 / 180.0 * 3.14159265;
    EXPECT_NEAR(volume_inside(mesh), whole, 0.012 * whole) << scale;
    EXPECT_LT(volume_inside(mesh), whole);
  }
}

TEST(SweepMesh, IsTheSameEveryTime) {
  expect_same_mesh(mesh_of_domain<3>("sweep"), mesh_of_domain<3>("sweep"));
  expect_edge_scales("sweep", 3);
}

}  // namespace
}  // namespace smoothfem
