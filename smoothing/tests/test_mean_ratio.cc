// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>

#include "smoothing/quality/mesh_quality.h"
#include "smoothing/simd/cells.h"
#include "smoothing/tests/planar_meshes.h"

namespace smoothfem {
namespace {

using test::make_mesh;
using Points = std::vector<Point<2>>;

double mean_ratio_of(const Points& corners) {
  std::vector<Vector2<double>> x;
  for (const auto& p : corners) x.push_back(vector_of(p));
  return mean_ratio(std::span<const Vector2<double>>(x));
}

Points regular_polygon(std::size_t n) {
  Points corners;
  for (std::size_t k = 0; k < n; ++k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
    corners.emplace_back(std::cos(angle), std::sin(angle));
  }
  return corners;
}

/// A convex n-gon that is not regular.
Points dented_polygon(std::size_t n) {
  Points corners = regular_polygon(n);
  test::Random random(n);
  for (auto& p : corners) p *= 1.0 + 0.1 * random();
  return corners;
}

/// Computes the mean ratio by matrices, as in the thesis: S = D W^-1, mean of 2 det(S) / |S|^2.
double mean_ratio_by_matrices(const Points& x) {
  const std::size_t n = x.size();
  const Points regular = regular_polygon(n);
  const auto edges = [n](const Points& p, std::size_t k) {
    Eigen::Matrix2d d;
    d << p[(k + 1) % n] - p[k], p[(k + n - 1) % n] - p[k];
    return d;
  };
  double sum = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Matrix2d s = edges(x, k) * edges(regular, k).inverse();
    sum += 2.0 * s.determinant() / s.squaredNorm();
  }
  return sum / static_cast<double>(n);
}

TEST(MeanRatio, RightIsoscelesTriangle) {
  EXPECT_NEAR(mean_ratio_of({{0, 0}, {1, 0}, {0, 1}}), 0.5 * std::numbers::sqrt3, 1e-15);
}

TEST(MeanRatio, RectangleTwiceAsLongAsHigh) {
  EXPECT_NEAR(mean_ratio_of({{0, 0}, {2, 0}, {2, 1}, {0, 1}}), 0.8, 1e-15);
}

// Corners with edges (2, 0), (0, 1): 2 * 2 / 5; (-1, 0), (0, -1) no: see the drawing
//   3 --- 2        corner 0: edges (2,0), (0,1), ratio 4/5;  corner 1: (-1,1), (-2,0), ratio 4/6
//   |      \       corner 2: (-1,0), (1,-1), ratio 2/3;      corner 3: (0,-1), (1,0), ratio 1
//   0 ------ 1
TEST(MeanRatio, Trapezoid) {
  const double by_hand = (4.0 / 5.0 + 4.0 / 6.0 + 2.0 / 3.0 + 1.0) / 4.0;
  EXPECT_NEAR(mean_ratio_of({{0, 0}, {2, 0}, {1, 1}, {0, 1}}), by_hand, 1e-15);
}

TEST(MeanRatio, RegularPolygonsAreIdeal) {
  for (std::size_t n = 3; n <= 12; ++n)
    EXPECT_NEAR(mean_ratio_of(regular_polygon(n)), 1.0, 1e-14) << n;
}

TEST(MeanRatio, InvalidCellsHaveQualityZero) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(mean_ratio_of({{0, 0}, {0, 1}, {1, 0}}), 0.0) << "clockwise";
  EXPECT_EQ(mean_ratio_of({{0, 0}, {1, 1}, {2, 2}}), 0.0) << "flat";
  EXPECT_EQ(mean_ratio_of({{0, 0}, {0, 0}, {0, 0}}), 0.0) << "a point";
  EXPECT_EQ(mean_ratio_of({{0, 0}, {1, 0}, {nan, 1}}), 0.0) << "not a number";
  EXPECT_EQ(mean_ratio_of({{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}}), 0.0) << "not convex";
  EXPECT_EQ(mean_ratio_of({{0, 0}, {1, 0}, {0, 1}, {1, 1}}), 0.0) << "crossed";
  EXPECT_EQ(mean_ratio_of({{0, 0}, {0, 0}, {1, 1}, {0, 1}}), 0.0) << "edge of length zero";
}

TEST(MeanRatio, AgreesWithMatrices) {
  for (std::size_t n = 3; n <= 8; ++n) {
    const Points x = dented_polygon(n);
    EXPECT_NEAR(mean_ratio_of(x), mean_ratio_by_matrices(x), 1e-14) << n;
    EXPECT_LT(mean_ratio_of(x), 1.0 - 1e-6) << n;
  }
}

TEST(MeanRatio, IsInvariantUnderSimilarity) {
  for (std::size_t n = 3; n <= 8; ++n) {
    Points x = dented_polygon(n);
    const double before = mean_ratio_of(x);
    for (auto& p : x) p = Point<2>(-300.0, 20.0) + 1e3 * (Eigen::Rotation2Dd(2.2) * p);
    EXPECT_NEAR(mean_ratio_of(x), before, 1e-12) << n;
  }
}

template <std::size_t n>
void expect_lanes_equal_scalars() {
  std::array<std::array<Vector2<double>, n>, n_lanes> cells;
  std::array<Vector2<Lanes>, n> block;
  test::Random random(n);
  for (std::size_t l = 0; l < n_lanes; ++l)
    for (std::size_t k = 0; k < n; ++k) {
      cells[l][k] = {random(), random()};  // some are invalid
      block[k].x[l] = cells[l][k].x;
      block[k].y[l] = cells[l][k].y;
    }
  const Lanes q = mean_ratio(std::span<const Vector2<Lanes>, n>(block));
  for (std::size_t l = 0; l < n_lanes; ++l)
    EXPECT_EQ(q[l], mean_ratio(std::span<const Vector2<double>, n>(cells[l]))) << n << ' ' << l;
}

TEST(MeanRatio, LanesAreBitwiseIdenticalToSingleCells) {
  expect_lanes_equal_scalars<3>();
  expect_lanes_equal_scalars<4>();
}

TEST(MeanRatio, BlocksOfCellsAreBitwiseIdenticalToSingleCells) {
  auto mesh = test::grid_mesh(7, test::GridCells::mixed);
  test::distort(mesh, 0.8, 3);
  const auto all = cell_mean_ratios(mesh);
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) EXPECT_EQ(all[c], cell_mean_ratio(mesh, c)) << c;
}

TEST(MeshQuality, TakesTheStarredMinimumOfFreeCells) {
  // A square with a centre node at (0.5, 0.5), and next to it a flat triangle of fixed nodes.
  const auto mesh = make_mesh({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.5}, {0.5, -0.01}},
                              {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 5, 1}});
  const MeshQuality quality = mesh_quality(mesh);
  const double right_isosceles = 0.5 * std::numbers::sqrt3;
  EXPECT_NEAR(quality.q_star_min, right_isosceles, 1e-14);
  EXPECT_LT(quality.q_min, 0.1);
  EXPECT_NEAR(quality.q_mean, (4.0 * right_isosceles + quality.q_min) / 5.0, 1e-14);
  EXPECT_EQ(quality.n_invalid, 0u);
}

TEST(MeshQuality, CountsInvalidCellsAndNamesThem) {
  auto mesh = test::grid_mesh(2, test::GridCells::quadrilaterals);
  mesh.coordinates()[4] = {1.9, 1.9};  // the last square gets a dent, the others are convex
  EXPECT_EQ(mesh_quality(mesh).n_invalid, 1u);
  try {
    require_valid(mesh, "some.mesh", std::vector<std::size_t>{11, 12, 13, 14});
    FAIL() << "nothing thrown";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text,
              "some.mesh:14: 1 of 4 cells is invalid: cell 3 at (1.9, 1.9) is not convex or "
              "degenerate; untangle the mesh first (--untangle)");
  }
}

TEST(MeshQuality, WithoutFreeCellsTheMinimaAreTheSame) {
  const auto mesh = make_mesh({{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}});
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_EQ(quality.q_star_min, quality.q_min);
}

/// A square of four triangles around a node near one side, and a thin triangle at another side.
TEST(CellsBelow, AreCountedWithAndWithoutFreeNodes) {
  const double low = 0.05;
  const CompressedRows<NodeIndex> cells = [] {
    CompressedRows<NodeIndex> rows;
    for (const std::vector<NodeIndex>& row :
         {std::vector<NodeIndex>{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 5, 2}})
      rows.append(row);
    return rows;
  }();
  const PlanarMesh mesh(std::make_shared<const Topology>(2, 6, cells),
                        {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, low}, {1 + low, 0.5}});
  const auto quality = cell_mean_ratios(mesh);
  ASSERT_LT(quality[0], 0.3);  // has the free node 4
  ASSERT_LT(quality[4], 0.3);  // has none
  for (const std::size_t c : {1, 2, 3}) ASSERT_GT(quality[c], 0.3);
  const std::vector<double> thresholds{0.3, 0.0, 1.0};
  const auto counts = count_cells_below(mesh, thresholds);
  ASSERT_EQ(counts.size(), 3U);
  EXPECT_EQ(counts[0].n, 2U);
  EXPECT_EQ(counts[0].n_star, 1U);
  EXPECT_EQ(counts[1].n, 0U);
  EXPECT_EQ(counts[2].n, 5U);
  EXPECT_EQ(counts[2].n_star, 4U);
  EXPECT_TRUE(count_cells_below(mesh, {}).empty());
}

TEST(QualityHistogram, CountsInEqualParts) {
  const std::vector<double> quality{0.0, 0.1, 0.25, 0.49, 0.5, 0.99, 1.0};
  EXPECT_EQ(quality_histogram(quality, 4), (std::vector<std::size_t>{2, 2, 1, 2}));
}

}  // namespace
}  // namespace smoothfem
