// SPDX-License-Identifier: GPL-3.0-or-later
/// Tests reading, writing and distortion of surface meshes.
#include "meshes/distortion/distort.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/surface/surface_constraints.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;

/// n x n squares on a saddle, the first ones cut into triangles.
SurfaceMesh saddle(NodeIndex n, MeshLabels labels = {}) {
  std::vector<Point<3>> x;
  for (NodeIndex j = 0; j <= n; ++j)
    for (NodeIndex i = 0; i <= n; ++i) {
      const double u = 2.0 * i / n - 1.0, v = 2.0 * j / n - 1.0;
      x.emplace_back(u, v, 0.3 * (u * u - v * v));
    }
  CompressedRows<NodeIndex> cells;
  for (NodeIndex j = 0; j < n; ++j)
    for (NodeIndex i = 0; i < n; ++i) {
      const NodeIndex a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = c - 1;
      if (j < 2) {
        cells.append(std::vector<NodeIndex>{a, b, c});
        cells.append(std::vector<NodeIndex>{a, c, d});
      } else {
        cells.append(std::vector<NodeIndex>{a, b, c, d});
      }
    }
  return make_surface_mesh(std::move(cells), std::move(x), std::move(labels));
}

class SurfaceFiles : public FileTest {};

TEST_F(SurfaceFiles, KeepEveryBitAndTheFeatures) {
  MeshLabels labels;
  labels.facets.append(std::vector<NodeIndex>{24, 25});
  labels.facet_tags = {3};
  const SurfaceMesh mesh = saddle(7, labels);
  for (const std::string name : {"s.vtu", "s.vtk", "s.msh"}) {
    SCOPED_TRACE(name);
    write_mesh(file(name), mesh);
    const MeshFile read = read_mesh(file(name));
    const auto* same = std::get_if<SurfaceMesh>(&read.mesh);
    ASSERT_NE(same, nullptr);
    EXPECT_EQ(same->copied_coordinates(), mesh.copied_coordinates());
    EXPECT_EQ(same->topology().cells(), mesh.topology().cells());
    EXPECT_EQ(same->topology().free_nodes(), mesh.topology().free_nodes());
    EXPECT_EQ(same->topology().labels().facet_tags, mesh.topology().labels().facet_tags);
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      EXPECT_EQ(same->constraints()->classifications()[i].kind,
                mesh.constraints()->classifications()[i].kind);
  }
}

TEST_F(SurfaceFiles, AreRefusedByFormatsWithoutSurfaces) {
  for (const std::string name : {"s.mesh", "s.inp"})
    EXPECT_THAT(input_error_of([&] { write_mesh(file(name), saddle(3)); }),
                HasSubstr("the format cannot hold surface meshes; use .vtu"));
}

TEST_F(SurfaceFiles, WithInconsistentOrientationAreRefusedWithTheirName) {
  const auto path = file_with("m.vtk",
                              "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                              "POINTS 4 double\n0 0 0\n1 0 0\n0 1 0\n1 1 1\n"
                              "CELLS 2 8\n3 0 1 2\n3 1 2 3\nCELL_TYPES 2\n5\n5\n");
  const std::string error = input_error_of([&] { read_mesh(path, {.turns_over = false}); });
  EXPECT_THAT(error, HasSubstr("m.vtk: "));
  EXPECT_THAT(error, HasSubstr("orient all facets alike"));
}

TEST(DistortedSurface, HasTheRequestedMeanQualityAndStaysOnTheSurface) {
  const SurfaceMesh mesh = saddle(16);
  SurfaceMesh distorted = mesh, again = mesh;
  DistortionParameters parameters;
  parameters.target_q_mean = 0.6;
  const auto result = distort(distorted, parameters);
  EXPECT_NEAR(result.q_mean, 0.6, parameters.tolerance);
  EXPECT_NEAR(mesh_quality(distorted).q_mean, 0.6, parameters.tolerance);
  EXPECT_EQ(mesh_quality(distorted).n_invalid, 0u);
  std::size_t n_moved = 0;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    const Point<3>& point = distorted.coordinates()[i];
    n_moved += point != mesh.coordinates()[i];
    EXPECT_LT(mesh.constraints()->distance(point), 1e-14);
    EXPECT_LT((mesh.constraints()->project(i, mesh.coordinates()[i], point) - point).norm(), 1e-14);
  }
  EXPECT_GT(n_moved, mesh.n_nodes() * 8 / 10);
  distort(again, parameters);
  EXPECT_EQ(again.copied_coordinates(), distorted.copied_coordinates());
}

}  // namespace
}  // namespace smoothfem
