// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tests/domain_tests.h"

namespace smoothfem {
namespace {

TEST(Pump, HasTheSizeAndTheRegularityOfTheThesis) {
  SKIP_UNLESS_LONG();
  const VolumeMesh mesh = mesh_of_domain<3>("pump");
  expect_valid(mesh);
  EXPECT_NEAR(static_cast<double>(mesh.n_nodes()), 2779096, 0.005 * 2779096);
  EXPECT_NEAR(static_cast<double>(mesh.n_cells()), 2646976, 0.005 * 2646976);
  std::size_t n_regular = 0;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    n_regular += mesh.topology().node_cells(i).size() == 8;
  EXPECT_NEAR(static_cast<double>(n_regular) / static_cast<double>(mesh.n_nodes()), 0.90, 0.005);
  EXPECT_EQ(euler_characteristic(mesh), 1 - 18);
}

TEST(Pump, CanBeMuchCoarser) {
  for (const double scale :
       test::short_or_long({3.0, 5.0, 8.0}, {1.5, 2.0, 2.8, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0})) {
    SCOPED_TRACE(scale);
    const VolumeMesh mesh = mesh_of_domain<3>("pump", {.edge_scale = scale});
    expect_valid(mesh);
    EXPECT_EQ(euler_characteristic(mesh), 1 - 18) << "all bores are there";
    const double n_cells = 2646976.0 / (scale * scale * scale);
    EXPECT_NEAR(static_cast<double>(mesh.n_cells()), n_cells, 0.25 * n_cells);
    EXPECT_GT(mesh_quality(mesh).q_mean, 0.85);
  }
  expect_edge_scales("pump", 8);
}

TEST(Pump, IsTheSameEveryTime) {
  const DomainParameters coarse{.edge_scale = 4.0};
  expect_same_mesh(mesh_of_domain<3>("pump", coarse), mesh_of_domain<3>("pump", coarse));
}

}  // namespace
}  // namespace smoothfem
