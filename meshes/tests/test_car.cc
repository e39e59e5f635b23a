// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tests/domain_tests.h"
#include "smoothing/geometry/cell_size.h"

namespace smoothfem {
namespace {

/// Euler characteristic of a block (1) with two passages around it. Each wheel joins the body,
/// which the plane of symmetry cuts, to the road; air flows around the wheel on its inner side.
constexpr long characteristic = 1 - 2;

/// Cells fill the air without overlapping: the sum of their volumes is the volume inside the
/// boundary.
void expect_filled(const VolumeMesh& mesh) {
  double sum = 0.0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) sum += signed_cell_size(mesh, c);
  EXPECT_NEAR(volume_inside(mesh), sum, 1e-6 * sum);
  constexpr double block = 16.0 * 5.0 * 5.0, two_boxes = 0.8 * (4.2 * 0.6 + 2.0 * 0.6);
  EXPECT_LT(sum, block - 0.5 * two_boxes);
  EXPECT_GT(sum, block - 1.2 * two_boxes);
}

TEST(Car, HasTheSizeAndTheQualityOfTheThesis) {
  const VolumeMesh mesh = mesh_of_domain<3>("car");
  expect_valid(mesh);
  EXPECT_NEAR(static_cast<double>(mesh.n_nodes()), 1710978, 0.02 * 1710978);
  EXPECT_NEAR(static_cast<double>(mesh.n_cells()), 1610234, 0.02 * 1610234);
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_NEAR(quality.q_mean, 0.6195, 0.005);
  EXPECT_NEAR(quality.q_min, 0.0043, 0.0003);
  EXPECT_EQ(euler_characteristic(mesh), characteristic);
  expect_filled(mesh);
}

/// The windscreen slopes, and the roof is narrower than the body. So the boundary has nodes where
/// two boxes have none, and none at their corners.
TEST(Car, HasTheShapeOfACar) {
  const VolumeMesh mesh = mesh_of_domain<3>("car", {.edge_scale = 4.0});
  const auto x = mesh.copied_coordinates();
  double highest = 0.0, highest_over_bonnet = 0.0, widest_roof = 0.0, widest = 0.0;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    const bool far = x[i].x() < -3.9 || x[i].x() > 11.9 || x[i].y() > 4.9 || x[i].z() > 4.9;
    if (!mesh.topology().on_boundary()[i] || far || x[i].y() == 0.0 || x[i].z() == 0.0) continue;
    highest = std::max(highest, x[i].z());
    widest = std::max(widest, x[i].y());
    if (x[i].x() < 1.0) highest_over_bonnet = std::max(highest_over_bonnet, x[i].z());
    if (x[i].z() > 1.35) widest_roof = std::max(widest_roof, x[i].y());
  }
  EXPECT_NEAR(highest, 1.43, 0.03);
  EXPECT_LT(highest_over_bonnet, 0.9);
  EXPECT_NEAR(widest, 0.8, 0.01);
  EXPECT_LT(widest_roof, 0.68);
}

TEST(Car, CanBeMuchCoarser) {
  std::size_t n_cells_before = 1610234 / 2;
  for (const double scale : {1.7, 2.1544, 4.0, 8.0}) {
    SCOPED_TRACE(scale);
    const VolumeMesh mesh = mesh_of_domain<3>("car", {.edge_scale = scale});
    expect_valid(mesh);
    EXPECT_EQ(euler_characteristic(mesh), characteristic);
    expect_filled(mesh);
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
