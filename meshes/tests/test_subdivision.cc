// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tests/domain_tests.h"

namespace smoothfem {
namespace {

TEST(Subdivision, IsThatOfTheThesis) {
  const VolumeMesh mesh = mesh_of_domain<3>("subdivision");
  expect_valid(mesh);
  EXPECT_EQ(mesh.n_nodes(), 6165u);
  EXPECT_EQ(mesh.n_cells(), 5984u);
  const Adjacency cells = adjacency(mesh, 8);
  EXPECT_EQ(cells.least, 1u);
  EXPECT_EQ(cells.most, 16u);
  EXPECT_NEAR(cells.mean, 7.8, 0.05);
  EXPECT_GT(cells.irregular_fraction, 0.48);
  EXPECT_NEAR(mesh_quality(mesh).q_min, 0.5400, 5e-5);
}

TEST(Subdivision, FillsTheCubeWithoutGaps) {
  for (const double scale : {1.0, 2.0, 3.0, 10.0}) {
    const VolumeMesh mesh = mesh_of_domain<3>("subdivision", {.edge_scale = scale});
    expect_valid(mesh);
    EXPECT_EQ(mesh.n_cells() % 8, 0u);
    EXPECT_EQ(euler_characteristic(mesh), 1);
    EXPECT_NEAR(volume_inside(mesh), 8e9, 1e-3);
    // Coinciding nodes are merged: the remaining boundary is the surface of the cube.
    EXPECT_EQ(mesh.topology().boundary_facets().size(), 96u);
  }
}

TEST(Subdivision, EachLevelAdds74CellsPerOctant) {
  const auto n_cells = [](double scale) {
    return mesh_of_domain<3>("subdivision", {.edge_scale = scale}).n_cells();
  };
  EXPECT_EQ(n_cells(5.0) - n_cells(10.0), 8u * 74u);
}

TEST(Subdivision, RefusesOtherEdgeScales) {
  expect_edge_scales("subdivision", 10);
}

}  // namespace
}  // namespace smoothfem
