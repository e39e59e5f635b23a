// SPDX-License-Identifier: GPL-3.0-or-later
/// Tests meshes of surfaces in space: projection, and that every method keeps nodes on the surface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "smoothing/base/parallel.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/mesh/interfaces.h"
#include "smoothing/surface/nearest_point.h"
#include "smoothing/surface/sliding_boundary.h"
#include "smoothing/surface/surface_constraints.h"
#include "smoothing/tests/methods.h"
#include "smoothing/tests/planar_meshes.h"

namespace smoothfem {
namespace {

using test::grid_mesh;
using test::GridCells;
using Turn = Eigen::Matrix<double, 3, 3>;

Turn a_turn() {
  return Eigen::AngleAxisd(0.9, Point<3>(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
}

/// Makes a surface from a planar mesh by moving its nodes to place(x, y).
template <class Place>
SurfaceMesh lifted(const PlanarMesh& plan, const Place& place) {
  std::vector<Point<3>> x;
  for (const auto& p : plan.copied_coordinates()) x.push_back(place(p.x(), p.y()));
  return make_surface_mesh(plan.topology().cells(), std::move(x));
}

/// A quarter of a cylinder's side: n x n cells, straight edges along it.
SurfaceMesh cylinder(std::uint32_t n, GridCells cells) {
  return lifted(grid_mesh(n, cells), [n](double u, double v) {
    const double angle = 0.5 * std::numbers::pi * u / n;
    return Point<3>(std::cos(angle), std::sin(angle), 1.5 * v / n);
  });
}
SurfaceMesh sphere_patch(std::uint32_t n, GridCells cells) {
  return lifted(grid_mesh(n, cells), [n](double u, double v) {
    return Point<3>(Point<3>(2.0 * u / n - 1.0, 2.0 * v / n - 1.0, 1.5).normalized());
  });
}
/// Two floors of a step and the wall between them: two feature lines inside.
SurfaceMesh bent_sheet(std::uint32_t n, GridCells cells) {
  const double third = n / 3.0;
  return lifted(grid_mesh(n, cells), [third](double u, double v) {
    const double along = std::min(u, third) + std::max(u - 2.0 * third, 0.0);
    return Point<3>(along, v, std::clamp(u - third, 0.0, third));
  });
}

/// Moves nodes at random where their cells stay valid, as far as their surface parts allow.
void disturb(SurfaceMesh& mesh, double radius, std::uint64_t seed) {
  test::Random random(seed);
  for (const NodeIndex i : mesh.topology().free_nodes()) {
    const Point<3> old = mesh.coordinates()[i];
    const double a = random(), b = random(), c = random();
    mesh.coordinates()[i] = allowed_position(mesh, i, Point<3>(old + radius * Point<3>(a, b, c)));
    for (const CellIndex cell : mesh.topology().node_cells(i))
      if (!(cell_mean_ratio(mesh, cell) > 0.0)) mesh.coordinates()[i] = old;
  }
}

std::vector<SurfaceMesh> surfaces() {
  std::vector<SurfaceMesh> all;
  for (const auto cells : {GridCells::triangles, GridCells::quadrilaterals, GridCells::mixed})
    for (const auto& mesh : {cylinder(9, cells), sphere_patch(9, cells), bent_sheet(9, cells)})
      all.push_back(mesh);
  return all;
}
double edge_length(const SurfaceMesh& mesh) {
  const auto nodes = mesh.topology().cell_nodes(0);
  return (mesh.coordinates()[nodes[1]] - mesh.coordinates()[nodes[0]]).norm();
}
std::vector<SurfaceMesh> disturbed_surfaces() {
  auto all = surfaces();
  for (auto& mesh : all) disturb(mesh, 0.4 * edge_length(mesh), 5);
  return all;
}

std::vector<NodeIndex> nodes_of_kind(const SurfaceMesh& mesh, GeometricClassification::Kind kind) {
  std::vector<NodeIndex> nodes;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    if (mesh.constraints()->classifications()[i].kind == kind) nodes.push_back(i);
  return nodes;
}

double farthest(const SurfaceMesh& a, const SurfaceMesh& b) {
  double longest = 0.0;
  for (std::size_t i = 0; i < a.n_nodes(); ++i)
    longest = std::max(longest, (a.coordinates()[i] - b.coordinates()[i]).norm());
  return longest;
}

// --- Nearest points ------------------------------------------------------------------------------

TEST(NearestPoint, OfATriangleInEveryRegion) {
  const Point<3> a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  const auto expect = [&](const Point<3>& p, const Point<3>& nearest) {
    EXPECT_LT((nearest_on_triangle(p, a, b, c) - nearest).norm(), 1e-15) << p.transpose();
  };
  expect({1, 1, 5}, {1, 1, 0});
  expect({-1, -2, 1}, {0, 0, 0});
  expect({6, -1, 3}, {4, 0, 0});
  expect({-1, 7, 0}, {0, 4, 0});
  expect({2, -3, 1}, {2, 0, 0});
  expect({-3, 1, 1}, {0, 1, 0});
  expect({4, 4, -2}, {2, 2, 0});
}

TEST(NearestPoint, OfDegenerateTrianglesAndSegments) {
  EXPECT_EQ(nearest_on_segment<3>({3, 1, 0}, {1, 1, 1}, {1, 1, 1}), Point<3>(1, 1, 1));
  EXPECT_EQ(nearest_on_triangle({1, 5, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}), Point<3>(1, 0, 0));
}

// --- Features ------------------------------------------------------------------------------------

TEST(SurfaceFeatures, OfAStepAreItsBoundaryAndTwoLines) {
  const auto mesh = bent_sheet(9, GridCells::quadrilaterals);
  // Corners: four of the sheet, and the ends of both lines on two sides.
  EXPECT_EQ(nodes_of_kind(mesh, GeometricClassification::corner).size(), 8u);
  // 8 inner nodes of each line; the boundary has 36 nodes.
  EXPECT_EQ(nodes_of_kind(mesh, GeometricClassification::line).size(), 2u * 8u + (36u - 8u));
  EXPECT_EQ(nodes_of_kind(mesh, GeometricClassification::patch).size(), 100u - 8u - 44u);
  for (const NodeIndex i : nodes_of_kind(mesh, GeometricClassification::corner))
    EXPECT_TRUE(mesh.topology().is_fixed(i));
  EXPECT_EQ(mesh.topology().free_nodes().size(), 92u);
}

TEST(SurfaceFeatures, FollowTheAngle) {
  // 12 facets around a quarter turn meet at 90 / 12 degrees.
  const auto smooth_one = cylinder(12, GridCells::quadrilaterals);
  EXPECT_EQ(nodes_of_kind(smooth_one, GeometricClassification::corner).size(), 4u);
  EXPECT_EQ(nodes_of_kind(smooth_one, GeometricClassification::line).size(), 44u);
  EXPECT_TRUE(nodes_of_kind(with_features(smooth_one, {.angle_degrees = 7.0}),
                            GeometricClassification::patch)
                  .empty());
  EXPECT_EQ(nodes_of_kind(with_features(smooth_one, {.angle_degrees = 8.0}),
                          GeometricClassification::patch)
                .size(),
            121u);
  const auto step = with_features(bent_sheet(9, GridCells::triangles), {.angle_degrees = 100.0});
  EXPECT_EQ(nodes_of_kind(step, GeometricClassification::corner).size(), 0u)
      << "no right angle counts";
}

TEST(SurfaceFeatures, AreBordersOfTagsAndLabelledEdgesToo) {
  const auto flat = grid_mesh(6, GridCells::quadrilaterals);
  MeshLabels labels;
  for (int c = 0; c < 36; ++c) labels.cell_tags.push_back(c % 6 < 3 ? 1 : 2);  // border at x = 3
  labels.facets.append(std::vector<NodeIndex>{15, 16});  // from (1, 2) to (2, 2)
  labels.facet_tags = {7};
  std::vector<Point<3>> x;
  for (const auto& p : flat.coordinates()) x.emplace_back(p.x(), p.y(), 0.1 * p.x());
  const auto mesh = make_surface_mesh(flat.topology().cells(), x, labels);
  for (NodeIndex j = 1; j < 6; ++j)
    EXPECT_EQ(mesh.constraints()->classifications()[7 * j + 3].kind, GeometricClassification::line)
        << j;
  for (const NodeIndex end : {15, 16})
    EXPECT_EQ(mesh.constraints()->classifications()[end].kind, GeometricClassification::corner)
        << "a line's end";
  EXPECT_EQ(nodes_of_kind(mesh, GeometricClassification::patch).size(), 25u - 5u - 2u);
}

TEST(SurfaceFeatures, AreRefusedForInconsistentlyOrientedFacets) {
  test::Cells cells{{0, 1, 2}, {1, 2, 3}};
  const std::vector<Point<3>> x{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}};
  try {
    make_surface_mesh(test::rows_of(cells), x);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("facets 0 and 1"));
    EXPECT_THAT(error.what(), testing::HasSubstr("orient all facets alike"));
  }
  cells[1] = {2, 1, 3};
  EXPECT_NO_THROW(make_surface_mesh(test::rows_of(cells), x));
  EXPECT_THROW(make_surface_mesh(test::rows_of(cells), x, {}, {}, {.angle_degrees = 0.0}),
               InputError);
}

// --- Projection ----------------------------------------------------------------------------------

TEST(NodeConstraints, ProjectOntoTheNodesOwnPart) {
  const auto mesh = bent_sheet(9, GridCells::quadrilaterals);
  const auto& constraints = *mesh.constraints();
  const auto node = [](NodeIndex i, NodeIndex j) { return 10 * j + i; };
  const auto expect = [&](NodeIndex i, const Point<3>& wanted, const Point<3>& expected) {
    const Point<3> place = constraints.project(i, mesh.coordinates()[i], wanted);
    EXPECT_LT((place - expected).norm(), 1e-14) << "node " << i << " goes to " << place.transpose();
  };
  expect(node(1, 4), {1.5, 4.25, 0.7}, {1.5, 4.25, 0.0});  // onto the floor
  expect(node(2, 4), {2.9, 4.0, 2.0}, {2.9, 4.0, 0.0});    // not onto the wall, which is nearer
  expect(node(4, 4), {2.0, 4.5, 1.5}, {3.0, 4.5, 1.5});    // onto the wall
  expect(node(3, 4), {2.0, 4.5, 1.0}, {3.0, 4.5, 0.0});    // along the line between them
  expect(node(1, 0), {1.75, 2.0, 1.0}, {1.75, 0.0, 0.0});  // along the boundary
  expect(node(1, 0), {9.0, 0.0, 0.0}, {3.0, 0.0, 0.0});    // up to a corner
  expect(node(3, 0), {5.0, 5.0, 5.0}, {3.0, 0.0, 0.0});    // a corner stays
  EXPECT_NEAR(constraints.distance({1.0, 1.0, -0.5}), 0.5, 1e-15);
  EXPECT_NEAR(constraints.distance({2.0, 1.0, 1.5}), 1.0, 1e-15);
}

/// Compares with a search of all segments and triangles by another formula: the minimum over a fine
/// net of points of the triangles cannot be lower.
TEST(NodeConstraints, FindTheNearestPoint) {
  const auto mesh = sphere_patch(6, GridCells::triangles);
  test::Random random(3);
  for (const NodeIndex i : nodes_of_kind(mesh, GeometricClassification::patch)) {
    const double a = random(), b = random(), c = random();
    const Point<3> wanted = mesh.coordinates()[i] + 0.5 * Point<3>(a, b, c);
    const Point<3> found = mesh.constraints()->project(i, mesh.coordinates()[i], wanted);
    EXPECT_LT(mesh.constraints()->distance(found), 1e-15);
    double least = 1e9;
    constexpr int n = 12;
    for (CellIndex cell = 0; cell < mesh.n_cells(); ++cell)
      for (int s = 0; s <= n; ++s)
        for (int t = 0; s + t <= n; ++t) {
          const auto nodes = mesh.topology().cell_nodes(cell);
          const Point<3> point =
              (s * mesh.coordinates()[nodes[0]] + t * mesh.coordinates()[nodes[1]] +
               (n - s - t) * mesh.coordinates()[nodes[2]]) /
              n;
          least = std::min(least, (point - wanted).norm());
        }
    EXPECT_LE((found - wanted).norm(), least + 1e-14);
    EXPECT_GT((found - wanted).norm(), least - edge_length(mesh) / n);
  }
}

TEST(SurfaceQuality, TurnsInvalidWhereACellTurnsOver) {
  auto mesh = sphere_patch(8, GridCells::triangles);
  const NodeIndex i = 4 * 9 + 4;
  EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
  mesh.coordinates()[i] =
      allowed_position(mesh, i, Point<3>(mesh.coordinates()[i] + Point<3>(0.6, 0.0, 0.0)));
  EXPECT_GT(mesh_quality(mesh).n_invalid, 0u);
  EXPECT_THROW(require_valid(mesh), InputError);
}

TEST(SurfaceQuality, OfAWarpedCellIsInvalidAtEachCornerThatTurnsOver) {
  const Vector3<double> up{0.0, 0.0, 1.0};
  const auto quality = [&](double z) {
    // A square whose last node comes in over the diagonal of the others, at height z.
    const std::array<Vector3<double>, 4> corners{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.6, 0.3, z}}};
    return mean_ratio(up, std::span<const Vector3<double>, 4>(corners));
  };
  EXPECT_EQ(quality(0.0), 0.0) << "as of the planar cell";
  EXPECT_EQ(quality(0.5), 0.0) << "though its mean normal points up";
  // By hand: triangles at the corners have the areas |e1 x e2| and squared sides |e1|^2 + |e2|^2.
  const std::array<Vector3<double>, 4> warped{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 1}}};
  const double at_first = 2.0 * std::sqrt(2.0) / 3.0, at_second = 1.0;
  const double at_third = 2.0 * std::sqrt(2.0) / 3.0, at_last = 2.0 * std::sqrt(3.0) / 4.0;
  EXPECT_NEAR(mean_ratio(up, std::span<const Vector3<double>, 4>(warped)),
              (at_first + at_second + at_third + at_last) / 4.0, 1e-15);
}

TEST(SurfaceQuality, OfAFlatCellIsThatOfThePlanarOne) {
  const Turn turn = a_turn();
  for (auto plan : {grid_mesh(6, GridCells::mixed), test::pentagon_mesh()}) {
    test::distort(plan, 0.3, 4);
    const auto flat =
        lifted(plan, [&](double x, double y) { return Point<3>(turn * Point<3>(x, y, 0.7)); });
    const auto expected = cell_mean_ratios(plan), q = cell_mean_ratios(flat);
    for (std::size_t c = 0; c < q.size(); ++c) EXPECT_NEAR(q[c], expected[c], 1e-14) << c;
  }
}

// --- Methods -------------------------------------------------------------------------------------

class SurfaceMethod : public testing::TestWithParam<std::string> {
 protected:
  static Method<2, 3> method() { return make_method<2, 3>(GetParam()); }
};

TEST_P(SurfaceMethod, KeepsNodesOnTheirPartsAndCornersWhereTheyAre) {
  for (const auto& mesh : disturbed_surfaces()) {
    SurfaceMesh result = mesh;
    auto made = method();
    smooth(result, made, [&](const IterationRecord& record, const SurfaceMesh& seen) {
      double longest = 0.0;
      for (const auto& p : seen.coordinates())
        longest = std::max(longest, mesh.constraints()->distance(p));
      EXPECT_LT(longest, 1e-12) << record.record;
      for (const NodeIndex i : nodes_of_kind(mesh, GeometricClassification::line)) {
        const Point<3> again =
            mesh.constraints()->project(i, mesh.coordinates()[i], seen.coordinates()[i]);
        EXPECT_LT((again - seen.coordinates()[i]).norm(), 1e-12) << i;
      }
    });
    EXPECT_EQ(test::n_moved_fixed_nodes(mesh, result), 0u);
    EXPECT_GT(mesh_quality(result).q_mean, mesh_quality(mesh).q_mean);
    if (test::claims_validity(made)) {
      EXPECT_EQ(mesh_quality(result).n_invalid, 0u);
    }
  }
}

TEST_P(SurfaceMethod, KeepsInterfacesAndSlidesAlongThem) {
  SurfaceMesh plain = sphere_patch(8, GridCells::triangles);
  disturb(plain, 0.4 * edge_length(plain), 5);
  MeshLabels labels;
  for (CellIndex c = 0; c < plain.n_cells(); ++c)
    labels.cell_tags.push_back(c < plain.n_cells() / 2 ? 1 : 2);
  const SurfaceMesh mesh =
      make_surface_mesh(plain.topology().cells(), plain.copied_coordinates(), labels);
  const auto interface = interface_nodes(mesh.topology());
  for (const auto rule : {InterfaceRule::fixed, InterfaceRule::slide}) {
    const SurfaceMesh before = with_interface_rule(mesh, rule);
    SurfaceMesh after = before;
    auto made = method();
    smooth(after, made);
    std::size_t n_moved = 0;
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
      if (!interface[i]) continue;
      const Point<3>& x = after.coordinates()[i];
      n_moved += x != mesh.coordinates()[i];
      EXPECT_LT((mesh.constraints()->project(i, mesh.coordinates()[i], x) - x).norm(), 1e-12) << i;
    }
    EXPECT_EQ(n_moved > 0, rule == InterfaceRule::slide);
  }
}

/// The planar methods serve as the second formula.
TEST_P(SurfaceMethod, GivesThePlanarMeshOnAFlatSurface) {
  const Turn turn = a_turn();
  const Point<3> shift(3.0, -1.0, 2.0);
  for (auto plan : {grid_mesh(7, GridCells::triangles), grid_mesh(7, GridCells::quadrilaterals),
                    grid_mesh(7, GridCells::mixed), test::pentagon_mesh()}) {
    const auto in_space = [&](const Point<2>& p) {
      return Point<3>(turn * Point<3>(p.x(), p.y(), 0.0) + shift);
    };
    auto flat = lifted(plan, [&](double x, double y) { return in_space({x, y}); });
    flat = with_fixed_nodes(flat, plan.topology().on_boundary());
    test::distort(plan, 0.3, 9);
    for (NodeIndex i = 0; i < plan.n_nodes(); ++i)
      flat.coordinates()[i] = in_space(plan.coordinates()[i]);
    auto planar_method = test::short_method<2>(GetParam(), "5");
    auto surface_method = test::short_method<2, 3>(GetParam(), "5");
    const auto a = smooth(plan, planar_method);
    const auto b = smooth(flat, surface_method);
    EXPECT_EQ(a.iterations_text(), b.iterations_text());
    for (NodeIndex i = 0; i < plan.n_nodes(); ++i)
      EXPECT_LT((flat.coordinates()[i] - in_space(plan.coordinates()[i])).norm(), 1e-11) << i;
  }
}

TEST_P(SurfaceMethod, CommutesWithRotations) {
  const Turn turn = a_turn();
  for (const auto& mesh : disturbed_surfaces()) {
    const auto turned = [&](SurfaceMesh m) {
      for (auto& p : m.coordinates()) p = turn * p;
      return m;
    };
    // The turned initial surface, not only the turned nodes.
    SurfaceMesh here = with_features(mesh, {}), there = with_features(turned(mesh), {});
    auto first = test::short_method<2, 3>(GetParam(), "5"),
         second = test::short_method<2, 3>(GetParam(), "5");
    EXPECT_EQ(smooth(here, first).iterations_text(), smooth(there, second).iterations_text());
    EXPECT_LT(farthest(turned(here), there), 1e-9);
  }
}

TEST_P(SurfaceMethod, IsBitwiseIdenticalForEveryNumberOfThreads) {
  const int default_threads = n_threads();
  auto mesh = sphere_patch(60, GridCells::mixed);
  disturb(mesh, 0.6 * edge_length(mesh), 8);
  std::vector<SurfaceMesh> results;
  for (const int threads : {1, 2, 5}) {
    set_n_threads(threads);
    results.push_back(mesh);
    auto made = test::short_method<2, 3>(GetParam(), "3");
    smooth(results.back(), made);
    EXPECT_EQ(results.back().copied_coordinates(), results.front().copied_coordinates()) << threads;
  }
  EXPECT_NE(results.front().copied_coordinates(), mesh.copied_coordinates());
  set_n_threads(default_threads);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, SurfaceMethod, testing::ValuesIn(methods_supporting<2, 3>()),
                         test::test_name);

TEST(SurfaceMethods, AreTheFiveOfTheThesisAndListedInErrors) {
  EXPECT_THAT((methods_supporting<2, 3>()),
              testing::ElementsAre("getme", "getme-sequential", "getme-simultaneous", "laplace",
                                   "smart-laplace"));
  try {
    make_method<2, 3>("global-optimization");
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "method global-optimization does not support surface meshes; choose one of getme, "
                 "getme-sequential, getme-simultaneous, laplace, smart-laplace");
  }
}

}  // namespace
}  // namespace smoothfem
