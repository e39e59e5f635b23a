// SPDX-License-Identifier: GPL-3.0-or-later
/// Nodes that slide on boundaries of second order: nearest points of quadratic pieces, features,
/// and the results of smoothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "smoothing/loop/smooth.h"
#include "smoothing/second_order/raise_order.h"
#include "smoothing/surface/nearest_point.h"
#include "smoothing/surface/quadratic_piece.h"
#include "smoothing/surface/sliding_boundary.h"
#include "smoothing/tests/curved_cells.h"
#include "smoothing/tests/methods.h"

namespace smoothfem {
namespace {

using test::box_mesh;
using test::BoxCells;
using test::grid_mesh;
using test::GridCells;

/// Nodes of a quadratic segment (3) or of a face, moved at random in space.
std::vector<Point<3>> random_piece(std::size_t n_nodes, double radius, test::Random& random) {
  std::vector<Point<3>> nodes{{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}};
  if (n_nodes > 3) nodes = shape_functions(2, n_nodes).nodes();
  for (auto& node : nodes)
    for (int d = 0; d < 3; ++d) node[d] += radius * random();
  return nodes;
}

/// Points of a piece on a grid of its reference domain, by the shape functions.
std::vector<Point<3>> points_of(const std::vector<Point<3>>& nodes, int n) {
  std::vector<Point<3>> points;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= (nodes.size() == 3 ? 0 : n); ++j) {
      const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n;
      if (nodes.size() < 8 && u + v > 1.0) continue;
      std::vector<double> values{(1 - u) * (1 - 2 * u), u * (2 * u - 1), 4 * u * (1 - u)};
      if (nodes.size() > 3) values = shape_functions(2, nodes.size()).values({u, v, 0.0});
      Point<3> x = Point<3>::Zero();
      for (std::size_t k = 0; k < nodes.size(); ++k) x += values[k] * nodes[k];
      points.push_back(x);
    }
  return points;
}

TEST(QuadraticPieces, NoPointOfAGridIsNearer) {
  test::Random random(3);
  for (const std::size_t n_nodes : {3U, 6U, 7U, 8U, 9U})
    for (int i = 0; i < 20; ++i) {
      SCOPED_TRACE(n_nodes);
      const auto nodes = random_piece(n_nodes, 0.1, random);
      const QuadraticPiece piece(nodes);
      const auto grid = points_of(nodes, 40);
      const Point<3> p(0.5 + random(), 0.3 + random(), 0.5 * random());
      const double distance = (piece.nearest(p) - p).norm();
      double least = 1e300;
      for (const auto& x : grid) {
        least = std::min(least, (x - p).norm());
        EXPECT_TRUE((x.array() >= piece.box().first.array() - 1e-12).all());
        EXPECT_TRUE((x.array() <= piece.box().second.array() + 1e-12).all());
      }
      EXPECT_LE(distance, least + 1e-12);
      EXPECT_GE(distance, least - 0.03) << "the nearest point is on the piece";
      for (const auto& x : points_of(nodes, 4))
        EXPECT_LT((piece.nearest(x) - x).norm(), 1e-13)
            << "a point of the piece is its own nearest";
    }
}

TEST(QuadraticPieces, FlatOnesHaveTheNearestPointsOfTriangles) {
  const Point<3> a(0, 0, 0), b(2, 0, 0), c(0, 1, 1);
  const QuadraticPiece piece(
      std::vector<Point<3>>{a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)});
  test::Random random(4);
  for (int i = 0; i < 50; ++i) {
    const Point<3> p(2.0 * random(), 2.0 * random(), 2.0 * random());
    EXPECT_LT((piece.nearest(p) - nearest_on_triangle(p, a, b, c)).norm(), 1e-12);
  }
  const Point<3> normal = (b - a).cross(c - a).normalized();
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LT((piece.normal_at_side(k) - normal).norm(), 1e-14);
}

/// A hexagon of six triangles, whose sides are arcs of the unit circle if `round`.
PlanarMesh hexagon(bool round) {
  std::vector<Point<2>> points;
  CompressedRows<NodeIndex> cells;
  for (NodeIndex k = 0; k < 6; ++k) {
    const double angle = std::numbers::pi / 3.0 * k;
    points.emplace_back(std::cos(angle), std::sin(angle));
    cells.append(std::array<NodeIndex, 3>{k, (k + 1) % 6, 6});
  }
  points.emplace_back(0.1, -0.2);
  PlanarMesh mesh =
      with_midside_nodes(PlanarMesh(std::make_shared<const Topology>(2, 7, cells), points));
  for (CellIndex c = 0; round && c < 6; ++c) {
    Point<2>& middle = mesh.coordinates()[mesh.topology().midside_nodes(c)[0]];
    middle.normalize();
  }
  return mesh;
}

TEST(CurvedSliding, TangentsMakeCornersNotChords) {
  const auto kind_of = [](const PlanarMesh& mesh, NodeIndex node) {
    return with_sliding_boundary(mesh).constraints()->classifications()[node].kind;
  };
  for (NodeIndex k = 0; k < 6; ++k) {
    EXPECT_EQ(kind_of(hexagon(true), k), GeometricClassification::line);
    EXPECT_EQ(kind_of(hexagon(false), k), GeometricClassification::corner);
  }
  const auto round = hexagon(true);
  EXPECT_EQ(kind_of(round, round.topology().midside_nodes(0)[0]), GeometricClassification::line);
  EXPECT_EQ(kind_of(round, round.topology().midside_nodes(0)[1]), GeometricClassification::none);
}

/// A mesh whose corners are moved inside, and whose boundary is bent into a smooth surface.
template <int dim>
Mesh<dim> bent(const Mesh<dim>& linear, SecondOrderKind kind, double size) {
  Mesh<dim> corners = linear;
  test::distort(corners, 0.2, 3);
  Mesh<dim> mesh = with_midside_nodes(corners, kind);
  for (auto& p : mesh.coordinates()) {
    const Point<dim> q = p / size;
    for (int d = 0; d < dim; ++d)
      p[d] += 0.15 * size * q[d] * (1.0 - q[d]) * std::sin(3.0 * q[(d + 1) % dim] + d) +
              0.1 * size * q[(d + 1) % dim] * (1.0 - q[(d + 1) % dim]);
  }
  return mesh;
}

template <int dim>
void expect_sliding(const Mesh<dim>& initial, const std::string& name) {
  ASSERT_EQ(mesh_quality(initial).n_invalid, 0u);
  Mesh<dim> mesh = with_sliding_boundary(initial);
  auto method = make_method<dim>(name);
  const SmoothingResult result = smooth(mesh, method);
  EXPECT_EQ(result.quality.n_invalid, 0u);
  EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
  std::size_t n_moved = 0;
  const auto x = std::as_const(mesh).coordinates();
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    if (mesh.constraints()->classifications()[i].kind != GeometricClassification::none) {
      EXPECT_LT(mesh.constraints()->distance(x[i]), 1e-12) << i;
      n_moved += x[i] != std::as_const(initial).coordinates()[i];
    }
  EXPECT_GT(n_moved, 0u);
}

class MethodsThatSlide : public testing::TestWithParam<std::string> {};

TEST_P(MethodsThatSlide, KeepAllNodesOfTheBoundaryOnTheCurvedSurface) {
  for (const auto kind : {SecondOrderKind::complete, SecondOrderKind::serendipity}) {
    for (const auto cells : {GridCells::triangles, GridCells::quadrilaterals})
      expect_sliding<2>(bent(grid_mesh(4, cells), kind, 4.0), GetParam());
    for (const auto cells : {BoxCells::tetrahedra, BoxCells::prisms, BoxCells::hexahedra})
      expect_sliding<3>(bent(box_mesh(3, 3, 3, cells), kind, 3.0), GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(Some, MethodsThatSlide,
                         testing::Values("laplace", "smart-laplace", "getme", "getme-simultaneous"),
                         test::test_name);

TEST(CurvedSliding, OnStraightSidesEqualsThatOfTheLinearMesh) {
  Mesh<2> straight = with_sliding_boundary(with_midside_nodes(grid_mesh(4, GridCells::triangles))),
          linear = with_sliding_boundary(grid_mesh(4, GridCells::triangles));
  auto method = make_method<2>("laplace");
  smooth(straight, method);
  smooth(linear, method);
  for (NodeIndex i = 0; i < linear.n_nodes(); ++i)
    EXPECT_LT(
        (std::as_const(straight).coordinates()[i] - std::as_const(linear).coordinates()[i]).norm(),
        1e-12);
}

}  // namespace
}  // namespace smoothfem
