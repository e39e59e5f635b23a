// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "smoothing/base/parallel.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/optimization/shape_objective.h"
#include "smoothing/optimization/untangle.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using test::box_mesh;
using test::BoxCells;
using test::grid_mesh;
using test::GridCells;

/// Moves each free node by up to `radius` in each direction, even if cells become invalid.
template <int dim>
Mesh<dim> scrambled(Mesh<dim> mesh, double radius, std::uint64_t seed) {
  test::Random random(seed);
  for (const NodeIndex i : mesh.topology().free_nodes())
    for (int d = 0; d < dim; ++d) mesh.coordinates()[i][d] += radius * random();
  return mesh;
}

std::vector<PlanarMesh> planar_meshes() {
  return {grid_mesh(8, GridCells::triangles), grid_mesh(8, GridCells::quadrilaterals),
          grid_mesh(8, GridCells::mixed), test::pentagon_mesh(), test::honeycomb_mesh()};
}
std::vector<VolumeMesh> volume_meshes() {
  std::vector<VolumeMesh> meshes;
  for (const BoxCells kind : {BoxCells::tetrahedra, BoxCells::pyramids, BoxCells::prisms,
                              BoxCells::hexahedra, BoxCells::mixed})
    meshes.push_back(box_mesh(5, 5, kind == BoxCells::mixed ? 10 : 5, kind));
  return meshes;
}

template <int dim>
void expect_untangled(const std::vector<Mesh<dim>>& meshes, double radius) {
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const Mesh<dim> tangled = scrambled(meshes[m], radius, seed);
      Mesh<dim> mesh = tangled;
      const auto result = untangle(mesh);
      EXPECT_EQ(result.n_invalid_before, mesh_quality(tangled).n_invalid);
      EXPECT_TRUE(result.valid) << "mesh " << m << " seed " << seed << ": "
                                << result.n_invalid_before << " -> " << result.n_invalid_after;
      EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
      for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
        if (mesh.topology().is_fixed(i)) {
          EXPECT_EQ(mesh.copied_coordinates()[i], tangled.copied_coordinates()[i]);
        }
    }
}

TEST(Untangle, UntanglesScrambledPlanarMeshes) {
  for (const double radius : {0.6, 1.5, 4.0}) expect_untangled(planar_meshes(), radius);
}
TEST(Untangle, UntanglesScrambledVolumeMeshes) {
  for (const double radius : {0.6, 1.5, 4.0}) expect_untangled(volume_meshes(), radius);
}

TEST(Untangle, UntanglesMeshesWithAllFreeNodesInAPlaneOrAPoint) {
  for (const auto& regular : volume_meshes())
    for (const int n_equal : {1, 3}) {
      auto mesh = regular;
      for (const NodeIndex i : mesh.topology().free_nodes())
        for (int d = 0; d < n_equal; ++d) mesh.coordinates()[i][d] = 2.3 + 0.1 * d;
      EXPECT_TRUE(untangle(mesh).valid);
    }
}

TEST(Untangle, KeepsValidMeshes) {
  auto mesh = box_mesh(4, 4, 4, BoxCells::hexahedra);
  test::distort(mesh, 0.6, 3);
  const auto before = mesh.copied_coordinates();
  const auto result = untangle(mesh);
  EXPECT_TRUE(result.valid);
  EXPECT_EQ(result.n_sweeps, 0);
  EXPECT_EQ(mesh.copied_coordinates(), before);
}

TEST(Untangle, NamesCellsThatCannotBeUntangled) {
  auto mesh = test::make_mesh({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 3, 2}});
  const auto before = mesh.copied_coordinates();
  const auto result = untangle(mesh);
  EXPECT_FALSE(result.valid);
  EXPECT_EQ(result.fully_fixed_cells, std::vector<CellIndex>{1});
  EXPECT_EQ(result.n_invalid_after, 1u);
  EXPECT_EQ(mesh.copied_coordinates(), before);
}

TEST(Untangle, ReportsInvalidCellsAndKeepsTheMeshIfItFails) {
  // The boundary itself is folded: no position of the inner node makes all triangles positive.
  auto mesh = test::make_mesh({{0, 0}, {1, 0}, {0, 1}, {1, 1}, {0.5, 0.4}},
                              {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
  const auto before = mesh.copied_coordinates();
  const auto result = untangle(mesh);
  EXPECT_FALSE(result.valid);
  EXPECT_GT(result.n_invalid_after, 0u);
  EXPECT_EQ(result.n_invalid_after, result.invalid_cells.size());
  EXPECT_TRUE(result.fully_fixed_cells.empty());
  EXPECT_EQ(mesh.copied_coordinates(), before);
}

TEST(Untangle, FollowsScale) {
  for (const auto& regular : volume_meshes())
    for (const double scale : {1e-9, 1e9}) {
      auto mesh = scrambled(regular, 1.0, 5), scaled = mesh;
      for (auto& p : scaled.coordinates()) p *= scale;
      const auto here = untangle(mesh), there = untangle(scaled);
      EXPECT_TRUE(there.valid);
      EXPECT_EQ(here.n_sweeps, there.n_sweeps);
    }
}

TEST(Untangle, DoesNotDependOnTheNumberOfThreads) {
  const int before = n_threads();
  const auto tangled = scrambled(box_mesh(24, 24, 24, BoxCells::tetrahedra), 0.7, 2);
  std::optional<std::vector<Point<3>>> expected;
  for (const int n : {1, 2, 3, 8}) {
    set_n_threads(n);
    auto mesh = tangled;
    EXPECT_TRUE(untangle(mesh, {.sweeps = 12}).valid);
    if (!expected) expected = mesh.copied_coordinates();
    EXPECT_EQ(mesh.copied_coordinates(), *expected) << n << " threads";
  }
  set_n_threads(before);
}

TEST(Untangle, LeadsToTheSameOptimumAsTheValidMesh) {
  for (const auto& regular : volume_meshes()) {
    const ShapeObjective<3> objective(regular.shared_topology());
    auto valid = regular, mesh = scrambled(regular, 1.0, 7);
    ASSERT_TRUE(untangle(mesh).valid);
    for (VolumeMesh* m : {&valid, &mesh}) {
      Method<3> method = make_method<3>("global-optimization");
      smooth(*m, method);
    }
    const double expected = objective.value(valid.coordinates());
    EXPECT_NEAR(objective.value(mesh.copied_coordinates()), expected, 1e-6 * expected);
  }
}

}  // namespace
}  // namespace smoothfem
