// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/distortion/distort.h"
#include "meshes/tests/domain_tests.h"
#include "smoothing/loop/preset.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/simd/cells.h"
#include "smoothing/surface/surface_constraints.h"

namespace smoothfem {
namespace {

SurfaceMesh roof(double edge_scale = 1.0) {
  return std::get<SurfaceMesh>(find_domain("roof").generate({.edge_scale = edge_scale}));
}

std::vector<NodeIndex> nodes_of_kind(const SurfaceMesh& mesh, GeometricClassification::Kind kind) {
  std::vector<NodeIndex> nodes;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    if (mesh.constraints()->classifications()[i].kind == kind) nodes.push_back(i);
  return nodes;
}

TEST(Roof, HasTheCountsAndTheQualityOfTheThesis) {
  const SurfaceMesh mesh = roof();
  EXPECT_EQ(mesh.n_nodes(), 23101u);
  EXPECT_EQ(mesh.n_cells(), 22676u);
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_EQ(quality.n_invalid, 0u);
  EXPECT_NEAR(quality.q_mean, 0.9814, 0.0005);
  EXPECT_NEAR(quality.q_star_min, 0.2467, 0.0005);
  EXPECT_EQ(euler_characteristic(mesh), 1 - 2) << "a disc without two rings";
  const Adjacency cells = adjacency(mesh, 4);
  EXPECT_GT(cells.irregular_fraction, 0.0) << "unstructured";
  EXPECT_LT(cells.irregular_fraction, 0.01) << "in rows";
}

TEST(Roof, HasNoFeaturesButAnchorsCablesAndRings) {
  for (const double scale : {1.0, 2.0, 3.0}) {
    SCOPED_TRACE(scale);
    const SurfaceMesh mesh = roof(scale);
    EXPECT_EQ(nodes_of_kind(mesh, GeometricClassification::corner).size(), 6u);
    std::set<std::uint32_t> lines;
    for (const NodeIndex i : nodes_of_kind(mesh, GeometricClassification::line)) {
      EXPECT_TRUE(mesh.topology().on_boundary()[i]) << i;
      lines.insert(mesh.constraints()->classifications()[i].part);
    }
    EXPECT_EQ(lines.size(), 6u + 2u);
  }
}

TEST(Roof, IsHighestAtItsRingsAndLowestAtItsAnchors) {
  const SurfaceMesh mesh = roof(2.0);
  const auto height = [&](NodeIndex i) { return mesh.coordinates()[i].z(); };
  double anchors = -1e9, others = 1e9;
  for (const NodeIndex i : nodes_of_kind(mesh, GeometricClassification::corner))
    anchors = std::max(anchors, height(i));
  NodeIndex highest = 0;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    if (height(i) > height(highest)) highest = i;
    if (!mesh.topology().on_boundary()[i]) others = std::min(others, height(i));
  }
  EXPECT_TRUE(mesh.topology().on_boundary()[highest]);
  EXPECT_GT(height(highest), anchors + 5.0) << "metres, of a roof 36 metres wide";
}

/// As in the thesis, where the q_mean differ by 0.0001.
TEST(Roof, SmoothsToEqualBetterMeanQualityDistortedOrNot) {
  SurfaceMesh mesh = roof(2.0), distorted = mesh;
  const double initial = mesh_quality(mesh).q_mean;
  distort(distorted, {.target_q_mean = 0.4983});
  std::vector<double> q_mean;
  for (SurfaceMesh* start : {&mesh, &distorted}) {
    auto method = make_method<2, 3>("getme");
    apply_preset(find_preset("thesis-5.1"), method);
    q_mean.push_back(smooth(*start, method).quality.q_mean);
  }
  EXPECT_NEAR(q_mean[0], q_mean[1], 0.001);
  EXPECT_GT(q_mean[0], initial + 0.001);
}

TEST(Roof, DistortedMeshDefinesItsOwnSurface) {
  SurfaceMesh mesh = roof();
  distort(mesh, {.target_q_mean = 0.7});
  // As after reading a file: the distorted mesh becomes the surface.
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    with_corners<2>(mesh.topology().cell_nodes(c), mesh.coordinates().data(), [&](auto corners) {
      EXPECT_GT(mean_ratio(unit_normal(corners), corners), 0.0) << c;
    });
  }
}

TEST(Roof, CanBeCoarserAndIsTheSameEveryTime) {
  std::size_t n_cells_before = 22676 / 2;
  for (const double scale : {1.5, 2.0, 3.0}) {
    SCOPED_TRACE(scale);
    const SurfaceMesh mesh = roof(scale);
    EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
    EXPECT_LT(mesh.n_cells(), n_cells_before);
    n_cells_before = mesh.n_cells();
    EXPECT_EQ(roof(scale).copied_coordinates(), mesh.copied_coordinates());
  }
  expect_edge_scales("roof", 3);
}

}  // namespace
}  // namespace smoothfem
