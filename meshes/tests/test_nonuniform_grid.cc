// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tests/domain_tests.h"
#include "meshes/tools/tensor_grid.h"

namespace smoothfem {
namespace {

TEST(NonuniformGrid, HasTheCountsAndMeanRatiosOfTheThesis) {
  for (const std::string name : {"nonuniform-grid", "nonuniform-grid-z", "nonuniform-grid-sinh"}) {
    const VolumeMesh mesh = mesh_of_domain<3>(name);
    expect_valid(mesh);
    EXPECT_EQ(mesh.n_nodes(), 572u);
    EXPECT_EQ(mesh.n_cells(), 360u);
    EXPECT_EQ(mesh.topology().free_nodes().size(), 198u);
    const MeshQuality quality = mesh_quality(mesh);
    EXPECT_NEAR(quality.q_min, 0.0010, 1e-6) << name;
    EXPECT_NEAR(quality.q_mean, 0.0943, 1e-5) << name;
    const std::vector<double> ratios = cell_mean_ratios(mesh);
    EXPECT_NEAR(*std::max_element(ratios.begin(), ratios.end()), 0.5714, 1e-5) << name;
    EXPECT_EQ(adjacency(mesh, 8).irregular_fraction, 0.0);
  }
}

TEST(NonuniformGrid, HasFewerPlanesOnLargerScales) {
  EXPECT_EQ(mesh_of_domain<3>("nonuniform-grid", {.edge_scale = 2.0}).n_nodes(), 7u * 4u * 7u);
  EXPECT_EQ(mesh_of_domain<3>("nonuniform-grid", {.edge_scale = 5.0}).n_nodes(), 3u * 4u * 3u);
  expect_edge_scales("nonuniform-grid", 5);
}

TEST(TensorGrid, LeavesOutCellsAndTheirNodes) {
  const std::array<std::vector<double>, 3> planes{{{0, 1, 3}, {0, 2, 3}, {0, 1}}};
  const VolumeMesh all = mesh_of(tensor_grid(planes), "grid");
  EXPECT_EQ(all.n_nodes(), 18u);
  EXPECT_DOUBLE_EQ(volume_inside(all), 9.0);
  const VolumeMesh most =
      mesh_of(tensor_grid(planes, [](auto i, auto j, auto) { return i == 0 || j == 0; }), "grid");
  EXPECT_EQ(most.n_nodes(), 16u);
  EXPECT_DOUBLE_EQ(volume_inside(most), 9.0 - 2.0 * 1.0);
}

}  // namespace
}  // namespace smoothfem
