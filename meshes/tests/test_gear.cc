// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/domains/gear.h"

#include <numbers>

#include "meshes/domains/catalogue.h"
#include "meshes/tests/mesh_tests.h"
#include "meshes/tools/quad_split.h"
#include "meshes/tools/triangulation_edits.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;

long euler_characteristic(const PlanarMesh& mesh) {
  return static_cast<long>(mesh.n_nodes()) - static_cast<long>(mesh.topology().n_edges()) +
         static_cast<long>(mesh.n_cells());
}

/// Twice the area inside the boundary edges, by Green's theorem: independent of the cells.
double area_inside(const PlanarMesh& mesh) {
  double twice = 0.0;
  const auto& sides = mesh.topology().boundary_facets();
  for (std::size_t s = 0; s < sides.size(); ++s)
    twice += cross(mesh.coordinates()[sides[s][0]], mesh.coordinates()[sides[s][1]]);
  return 0.5 * twice;
}

class Gear : public ::testing::TestWithParam<ElementType> {};

TEST_P(Gear, HasTheCountsAndTheBoxOfThePublishedMesh) {
  const bool tri = GetParam() == ElementType::triangle;
  const PlanarMesh mesh = generate_gear(gear_of_the_thesis(GetParam()));
  const Topology& topology = mesh.topology();
  const double n_cells = tri ? 14346 : 6229;
  EXPECT_NEAR(static_cast<double>(mesh.n_cells()), n_cells, tri ? 0 : 0.01 * n_cells);
  EXPECT_EQ(topology.boundary_facets().size(), 982u);
  EXPECT_EQ(mesh.n_nodes() - topology.free_nodes().size(), 982u);
  EXPECT_EQ(euler_characteristic(mesh), 1 - 5);
  EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) ASSERT_EQ(topology.cell_type(c), GetParam());
  Point<2> low = mesh.coordinates()[0], high = low;
  for (const auto& point : mesh.coordinates()) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  EXPECT_LT((low - Point<2>(-9.38, -9.48)).norm(), 0.01);
  EXPECT_LT((high - Point<2>(9.50, 9.48)).norm(), 0.01);
}

TEST_P(Gear, IsValidWithATenthOfTheCells) {
  const PlanarMesh mesh = generate_gear(gear_of_the_thesis(GetParam(), 3.0));
  EXPECT_EQ(mesh.topology().boundary_facets().size(), 326u);
  EXPECT_EQ(euler_characteristic(mesh), -4);
  EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
  const PlanarMesh finer = generate_gear(gear_of_the_thesis(GetParam(), 2.0));
  EXPECT_NEAR(area_inside(mesh) / area_inside(finer), 1.0, 0.01);
}

TEST_P(Gear, TheSameParametersGiveTheSameMesh) {
  GearParameters parameters = gear_of_the_thesis(GetParam(), 2.0);
  const PlanarMesh first = generate_gear(parameters), second = generate_gear(parameters);
  expect_same_mesh(first, second);
  parameters.seed = 2;
  const PlanarMesh other = generate_gear(parameters);
  EXPECT_EQ(first.topology().cells() == other.topology().cells(),
            GetParam() == ElementType::quadrilateral);  // only flips of triangles are random
}

INSTANTIATE_TEST_SUITE_P(Types, Gear,
                         ::testing::Values(ElementType::triangle, ElementType::quadrilateral),
                         [](const auto& info) { return std::string(name_of(info.param)); });

TEST(GearOutline, CurvesJoinAndMoveWithConstantSpeed) {
  for (const auto& outline : gear_outlines({}))
    for (std::size_t c = 0; c < outline.size(); ++c) {
      const Curve& curve = outline[c];
      const Curve& next = outline[(c + 1) % outline.size()];
      EXPECT_LT((curve.point(1.0) - next.point(0.0)).norm(), 1e-12);
      constexpr int n = 1000;
      for (int i = 0; i < n; ++i) {
        const double step = (curve.point((i + 1.0) / n) - curve.point(1.0 * i / n)).norm();
        EXPECT_NEAR(step * n / curve.length, 1.0, 1e-4);
      }
    }
}

TEST(GearOutline, ToothAndGapAreEquallyWideAtThePitchCircle) {
  const GearParameters p;
  const double pitch_radius = 0.5 * p.module * p.n_teeth;
  // The first tooth's involute, from the base outwards.
  const Curve flank = gear_outlines(p).front()[1];
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (flank.point(middle).norm() < pitch_radius ? low : high) = middle;
  }
  const Point<2> crossing = flank.point(low);
  EXPECT_NEAR(std::atan2(crossing.y(), crossing.x()), -0.5 * std::numbers::pi / p.n_teeth, 1e-12);
  // At each point, the tangent of an involute and the radius make the pressure angle there.
  const Point<2> tangent = (flank.point(low + 1e-6) - flank.point(low - 1e-6)).normalized();
  EXPECT_NEAR(std::acos(tangent.dot(crossing.normalized())) * 180.0 / std::numbers::pi,
              p.pressure_angle_degrees, 1e-4);
}

TEST(GearErrors, NameImpossibleParameters) {
  const auto error_with = [](auto change) {
    GearParameters p = gear_of_the_thesis(ElementType::quadrilateral, 3.0);
    change(p);
    return input_error_of([&] { generate_gear(p); });
  };
  EXPECT_THAT(error_with([](auto& p) { p.n_boundary_edges = 327; }), HasSubstr("a multiple of 2"));
  EXPECT_THAT(error_with([](auto& p) { p.n_boundary_edges = 100; }), HasSubstr("from 308 on"));
  EXPECT_THAT(error_with([](auto& p) { p.n_teeth = 2; }), HasSubstr("at least 3 teeth"));
  EXPECT_THAT(error_with([](auto& p) { p.root_radius = 8.0; }), HasSubstr("base circle"));
  EXPECT_THAT(error_with([](auto& p) { p.tip_radius = 12.0; }), HasSubstr("pointed"));
  EXPECT_THAT(error_with([](auto& p) { p.kidney_fillet_radius = 3.0; }), HasSubstr("fillets"));
  EXPECT_THAT(error_with([](auto& p) { p.arm_length = 3.0; }), HasSubstr("overlap"));
  EXPECT_THAT(error_with([](auto& p) { p.bore_half_width = 0.1; }), HasSubstr("narrower"));
  EXPECT_THAT(error_with([](auto& p) { p.element_type = ElementType::polygon; }),
              HasSubstr("triangles or quadrilaterals only"));
  EXPECT_THAT(input_error_of([] { gear_of_the_thesis(ElementType::triangle, 0.5); }),
              HasSubstr("between 1 and 10"));
}

PlanarCells two_triangles(const Point<2>& apex) {
  PlanarCells mesh;
  mesh.coordinates = {{0, 0}, {1, 0}, {1, 1}, apex};
  mesh.cells.append(std::vector<NodeIndex>{0, 1, 2});
  mesh.cells.append(std::vector<NodeIndex>{0, 2, 3});
  return mesh;
}

TEST(TriangulationEdits, EdgesBetweenBoundaryNodesAreNotFlipped) {
  PlanarCells mesh = two_triangles({0, 1});
  EXPECT_EQ(flip_edges(mesh, 1, 1), 0u);
}

TEST(TriangulationEdits, RefineSplitsInnerEdgesOnly) {
  PlanarCells mesh = two_triangles({0, 1});
  refine_to(mesh, 5);  // an even number of triangles cannot become odd
  EXPECT_EQ(mesh.cells.size(), 4u);
  EXPECT_EQ(mesh.coordinates.back(), Point<2>(0.5, 0.5));
  const Topology topology(2, mesh.coordinates.size(), mesh.cells);
  EXPECT_EQ(topology.boundary_facets().size(), 4u);
  EXPECT_EQ(topology.node_cells(4).size(), 4u);
}

TEST(TriangulationEdits, FlipsKeepCountsValidityAndDegrees) {
  GearParameters parameters = gear_of_the_thesis(ElementType::triangle, 2.0);
  parameters.edge_flips_per_cell = 0.0;
  const PlanarMesh plain = generate_gear(parameters);
  PlanarCells cells = cells_of(plain);
  EXPECT_EQ(flip_edges(cells, 1000, 1), 1000u);
  EXPECT_EQ(cells.coordinates, plain.copied_coordinates());
  const PlanarMesh flipped(
      std::make_shared<const Topology>(2, cells.coordinates.size(), cells.cells),
      cells.coordinates);
  EXPECT_EQ(flipped.topology().n_edges(), plain.topology().n_edges());
  EXPECT_EQ(mesh_quality(flipped).n_invalid, 0u);
  EXPECT_NEAR(area_inside(flipped), area_inside(plain), 1e-12);
  for (const NodeIndex node : flipped.topology().free_nodes()) {
    EXPECT_GE(flipped.topology().node_neighbours(node).size(), 3u);
    EXPECT_LE(flipped.topology().node_neighbours(node).size(), 9u);
  }
  EXPECT_LT(mesh_quality(flipped).q_mean, mesh_quality(plain).q_mean - 0.05);
}

TEST(QuadSplit, TrianglesQuadrilateralsAndNonConvexOnes) {
  PlanarCells mesh = two_triangles({0, 1});
  EXPECT_EQ(split_to_quadrilaterals(mesh).cells.size(), 6u);
  mesh.cells = {};
  mesh.cells.append(std::vector<NodeIndex>{0, 1, 2, 3});
  EXPECT_EQ(split_to_quadrilaterals(mesh).cells.size(), 4u);
  mesh.coordinates[3] = {0.7, 0.6};  // a dart
  const PlanarCells split = split_to_quadrilaterals(mesh);
  EXPECT_EQ(split.cells.size(), 6u);
  const PlanarMesh result(
      std::make_shared<const Topology>(2, split.coordinates.size(), split.cells),
      split.coordinates);
  EXPECT_EQ(mesh_quality(result).n_invalid, 0u);
}

TEST(QuadSplit, PutsBoundaryMidpointsAtTheGivenPositions) {
  const PlanarCells split = split_to_quadrilaterals(
      two_triangles({0, 1}), [](NodeIndex a, NodeIndex b) { return Point<2>(100.0 + a, b); });
  std::size_t n_moved = 0;
  for (const auto& point : split.coordinates) n_moved += point.x() >= 100.0;
  EXPECT_EQ(n_moved, 4u);
}

TEST(Gear, IsADomain) {
  const AnyMesh mesh =
      find_domain("gear").generate({.elements = "quadrilaterals", .edge_scale = 3.0});
  EXPECT_EQ(std::get<PlanarMesh>(mesh).topology().boundary_facets().size(), 326u);
}

}  // namespace
}  // namespace smoothfem
