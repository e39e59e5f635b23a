// SPDX-License-Identifier: GPL-3.0-or-later
/// Tests meshes whose inverted cells have nodes of the boundary only: only nodes that slide along
/// it can untangle them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "smoothing/base/parallel.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/optimization/untangle.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/surface/line_constraints.h"
#include "smoothing/tests/tangled_boundary.h"

namespace smoothfem {
namespace {

using test::box_mesh;
using test::BoxCells;
using test::shell;
using test::strip;
using test::tangled_along_boundary;

std::vector<CellIndex> invalid_cells_of(const VolumeMesh& mesh) {
  return invalid_cells(cell_mean_ratios(mesh));
}

class UntangleSliding : public testing::TestWithParam<BoxCells> {};

TEST_P(UntangleSliding, UntanglesCellsWithBoundaryNodesOnly) {
  const VolumeMesh tangled = tangled_along_boundary(shell(GetParam()));
  const auto n_invalid = invalid_cells_of(tangled).size();
  ASSERT_GE(n_invalid, 20u);
  VolumeMesh fixed = tangled;
  const auto refused = untangle(fixed);
  EXPECT_EQ(refused.fully_fixed_cells.size(), n_invalid) << "with a fixed boundary";

  const VolumeMesh initial = with_sliding_boundary(tangled);
  VolumeMesh mesh = initial;
  const auto result = untangle(mesh);
  EXPECT_TRUE(result.valid) << n_invalid << " -> " << result.n_invalid_after;
  EXPECT_EQ(result.n_invalid_before, n_invalid);
  EXPECT_TRUE(invalid_cells_of(mesh).empty());
  const NodeConstraints<3>& constraints = *mesh.constraints();
  EXPECT_LE(constraints.facet_distance(mesh.coordinates()), constraints.facet_bound());
  std::size_t n_lines = 0;
  constexpr double sag = 0.03;  // of chords between nodes of the tangled mesh
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    EXPECT_LT(constraints.distance(mesh.coordinates()[i]), 1e-12) << i;
    if (constraints.is_corner(i)) {
      EXPECT_EQ(mesh.coordinates()[i], tangled.coordinates()[i]);
    }
    if (constraints.classifications()[i].kind != GeometricClassification::line) continue;
    ++n_lines;  // still on one of the tube's edges: in its ends, and on a side or an end in x
    const Point<3>& p = mesh.coordinates()[i];
    const double radius = p.head<2>().norm();
    const int n_planes = (std::abs(p.x()) < 1e-12) + (std::abs(p.y()) < 1e-12) +
                         (std::abs(p.z()) < 1e-12) + (std::abs(p.z() - 1.0) < 1e-12);
    const bool on_side = std::abs(radius - 1.5) < sag || std::abs(radius - 1.5 - 1.0 / 12) < sag;
    EXPECT_GE(n_planes + on_side, 2) << p.transpose();
  }
  EXPECT_GT(n_lines, 50u);
}

TEST_P(UntangleSliding, IsBitwiseIdenticalForEveryNumberOfThreads) {
  const VolumeMesh tangled = with_sliding_boundary(tangled_along_boundary(shell(GetParam())));
  const int before = n_threads();
  std::optional<std::vector<Point<3>>> expected;
  for (const int n : {1, 3}) {
    set_n_threads(n);
    VolumeMesh mesh = tangled;
    EXPECT_TRUE(untangle(mesh).valid);
    if (!expected) expected = mesh.copied_coordinates();
    EXPECT_EQ(mesh.copied_coordinates(), *expected) << n << " threads";
  }
  set_n_threads(before);
}

INSTANTIATE_TEST_SUITE_P(Cells, UntangleSliding,
                         testing::Values(BoxCells::hexahedra, BoxCells::tetrahedra,
                                         BoxCells::prisms),
                         [](const auto& info) { return std::string(name_of(info.param)); });

TEST(UntangleSlidingBoundaries, KeepFacetsWithinTheirBound) {
  const VolumeMesh tangled = tangled_along_boundary(shell(BoxCells::hexahedra));
  VolumeMesh mesh = with_sliding_boundary(tangled, {}, 1e-6);
  const auto result = untangle(mesh, {.max_rounds = 2});
  EXPECT_FALSE(result.valid) << "next to nothing may move";
  EXPECT_TRUE(result.fully_fixed_cells.empty());
  EXPECT_EQ(mesh.copied_coordinates(), tangled.copied_coordinates());
}

TEST(UntangleSlidingBoundaries, NamesCellsWithCornersOnly) {
  VolumeMesh cube = box_mesh(1, 1, 1, BoxCells::hexahedra);
  std::swap(cube.coordinates()[0], cube.coordinates()[1]);
  VolumeMesh mesh = with_sliding_boundary(cube);
  EXPECT_EQ(untangle(mesh).fully_fixed_cells, std::vector<CellIndex>{0});
}

TEST(UntangleSlidingInThePlane, UntanglesCellsWithBoundaryNodesOnly) {
  for (const bool triangles : {false, true}) {
    const PlanarMesh tangled = strip(triangles, 0.45);
    PlanarMesh fixed = tangled;
    const auto refused = untangle(fixed);
    ASSERT_GE(refused.n_invalid_before, 10u);
    EXPECT_EQ(refused.fully_fixed_cells.size(), refused.n_invalid_before);

    PlanarMesh mesh = with_sliding_boundary(tangled, {}, 0.1);
    const auto stays = [&](NodeIndex i) { return mesh.topology().is_fixed(i); };
    std::size_t n_fixed = 0;
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) n_fixed += stays(i);
    EXPECT_EQ(n_fixed, 4u);
    const auto result = untangle(mesh);
    EXPECT_TRUE(result.valid) << triangles << ": " << result.n_invalid_before << " -> "
                              << result.n_invalid_after;
    EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
    EXPECT_LE(mesh.constraints()->facet_distance(mesh.coordinates()),
              mesh.constraints()->facet_bound());
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
      const double initial = tangled.coordinates()[i].norm(), now = mesh.coordinates()[i].norm();
      EXPECT_NEAR(now, initial, 0.002) << "a chord's sag, " << i;
      if (stays(i)) {
        EXPECT_EQ(mesh.coordinates()[i], tangled.coordinates()[i]);
      }
    }
  }
}

TEST(LineConstraintsOfASquare, HaveItsCornersAndNoMore) {
  const PlanarMesh mesh =
      with_sliding_boundary(test::grid_mesh(4, test::GridCells::quadrilaterals), {}, 0.1);
  const NodeConstraints<2>& lines = *mesh.constraints();
  std::size_t n_corners = 0, n_inside = 0;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    const int n_directions = lines.classifications()[i].n_directions(2);
    n_corners += lines.is_corner(i);
    n_inside += n_directions == 2;
    EXPECT_EQ(n_directions < 2, static_cast<bool>(mesh.topology().on_boundary()[i]));
    EXPECT_EQ(lines.is_corner(i), mesh.topology().is_fixed(i));
  }
  EXPECT_EQ(n_corners, 4u);
  EXPECT_EQ(n_inside, 9u);
  EXPECT_DOUBLE_EQ(lines.facet_bound(), 0.1);
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    const Point<2> p = mesh.coordinates()[i];
    if (p != Point<2>(2.0, 0.0)) continue;
    EXPECT_EQ(lines.project(i, p, Point<2>(2.7, 0.4)), Point<2>(2.7, 0.0));
    auto x = mesh.copied_coordinates();
    x[i] = {2.0, 0.19};
    EXPECT_TRUE(lines.keeps_bound(x, {&i, 1}));
    EXPECT_TRUE(lines.facets_out_of_bound(x).empty());
    x[i] = {2.0, 0.21};
    EXPECT_FALSE(lines.keeps_bound(x, {&i, 1}));
    EXPECT_EQ(lines.facets_out_of_bound(x).size(), 2u);
    EXPECT_EQ(lines.facets_out_of_bound(x, {&i, 1}), lines.facets_out_of_bound(x));
    EXPECT_NEAR(lines.facet_distance(x), 0.105, 1e-15);
  }
}

}  // namespace
}  // namespace smoothfem
