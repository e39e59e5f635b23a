// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tests/domain_tests.h"

namespace smoothfem {
namespace {

/// Cubic metres: the block of air less the body's two boxes.
constexpr double air = 16.0 * 5.0 * 5.0 - 0.8 * (4.2 * 0.6 + 2.0 * 0.6);

TEST(Car, HasTheSizeAndTheQualityOfTheThesis) {
  const VolumeMesh mesh = mesh_of_domain<3>("car");
  expect_valid(mesh);
  EXPECT_NEAR(static_cast<double>(mesh.n_nodes()), 1710978, 0.02 * 1710978);
  EXPECT_NEAR(static_cast<double>(mesh.n_cells()), 1610234, 0.02 * 1610234);
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_NEAR(quality.q_mean, 0.6195, 0.005);
  EXPECT_NEAR(quality.q_min, 0.0043, 0.0003);
  EXPECT_EQ(euler_characteristic(mesh), 1);
  EXPECT_NEAR(volume_inside(mesh), air, 1e-9 * air);
}

TEST(Car, CanBeMuchCoarser) {
  std::size_t n_cells_before = 1610234 / 2;
  for (const double scale : {1.7, 2.1544, 4.0, 8.0}) {
    SCOPED_TRACE(scale);
    const VolumeMesh mesh = mesh_of_domain<3>("car", {.edge_scale = scale});
    expect_valid(mesh);
    EXPECT_EQ(euler_characteristic(mesh), 1);
    EXPECT_NEAR(volume_inside(mesh), air, 1e-9 * air);
    EXPECT_LT(mesh.n_cells(), n_cells_before);
    n_cells_before = mesh.n_cells();
    EXPECT_GT(mesh_quality(mesh).q_min, 0.002);
    expect_same_mesh(mesh, mesh_of_domain<3>("car", {.edge_scale = scale}));
  }
  EXPECT_LT(n_cells_before, 1610234u / 40);
  expect_edge_scales("car", 8);
}

}  // namespace
}  // namespace smoothfem
