// SPDX-License-Identifier: GPL-3.0-or-later
/// Validity and quality of cells of second order, against dense samples and exact numbers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <map>
#include <numeric>

#include "smoothing/base/parallel.h"
#include "smoothing/geometry/cell_size.h"
#include "smoothing/quality/cell_targets.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/second_order/curved_quality.h"
#include "smoothing/surface/surface_constraints.h"
#include "smoothing/tests/curved_cells.h"

namespace smoothfem {
namespace {

template <int dim>
bool proven_valid(const std::vector<Point<dim>>& points) {
  return is_proven_valid<dim>(std::span<const Point<dim>>(points));
}
template <int dim>
JacobianBounds bounds_of(const std::vector<Point<dim>>& points, double tolerance) {
  return jacobian_bounds<dim>(std::span<const Point<dim>>(points), tolerance);
}

/// The type with these nodes.
SecondOrderType type_of(int dim, std::size_t n_nodes) {
  return second_order_types[second_order_type(dim, n_nodes)];
}

template <int dim>
Mesh<dim> mesh_of_one_cell(const std::vector<Point<dim>>& corners) {
  std::vector<NodeIndex> row;
  for (NodeIndex k = 0; k < corners.size(); ++k) row.push_back(k);
  CompressedRows<NodeIndex> cells;
  cells.append(row);
  return {std::make_shared<const Topology>(dim, corners.size(), cells), corners};
}

/// The corners of a row.
template <int dim>
std::vector<Point<dim>> corners_of(const SecondOrderType& type, std::vector<Point<dim>> points) {
  points.resize(type.n_corners);
  return points;
}

// --- Bounds of det J -----------------------------------------------------------------------------

class CurvedCells : public testing::TestWithParam<SecondOrderType> {};

TEST_P(CurvedCells, HaveBoundsAroundAllSamples) {
  with_dimension(GetParam().dim, [&]<int dim>() {
    test::Random random(1);
    const auto samples =
        test::gradients_at(GetParam(), test::reference_samples(GetParam(), 100, random));
    std::size_t n_valid = 0, n_invalid = 0;
    for (int i = 0; i < 60; ++i) {
      const auto cell = test::random_cell<dim>(GetParam(), 0.015 * (i % 20), random);
      double least = std::numeric_limits<double>::infinity(), greatest = -least;
      for (const auto& gradients : samples) {
        const double value = test::jacobian(cell, gradients);
        least = std::min(least, value);
        greatest = std::max(greatest, value);
      }
      const bool valid = proven_valid(cell);
      ++(valid ? n_valid : n_invalid);
      if (valid) {
        EXPECT_GT(least, 0.0);
      }
      for (const double tolerance : {10.0, 1e-2}) {
        const auto [minimum, maximum] = bounds_of(cell, tolerance);
        // Samples have rounding errors, too.
        EXPECT_LE(minimum.lower, least + 1e-13);
        EXPECT_GE(maximum.upper, greatest - 1e-13);
        EXPECT_LE(minimum.lower, minimum.upper);
        EXPECT_LE(maximum.lower, maximum.upper);
        EXPECT_LE(minimum.upper, maximum.upper);
        const double size = std::max(std::abs(maximum.upper), std::abs(minimum.lower));
        EXPECT_LE(minimum.upper - minimum.lower, tolerance * size + 1e-6);
        EXPECT_LE(maximum.upper - maximum.lower, tolerance * size + 1e-6);
        if (tolerance < 1.0) {
          EXPECT_LE(minimum.upper, least + 0.3 * size) << "far from the samples";
          EXPECT_TRUE(valid || minimum.lower <= 0.0);
          EXPECT_FALSE(valid && minimum.upper < 0.0);
        }
      }
    }
    EXPECT_GT(n_valid, 10u);
    EXPECT_GT(n_invalid, 2u);
  });
}

/// A random cell; prisms and hexahedra have a random base and straight vertical edges.
template <int dim>
std::vector<Point<dim>> random_cell_or_column(const SecondOrderType& type, test::Random& random) {
  constexpr double radius = 0.3;
  if constexpr (dim == 3)
    if (type.n_corners > 5) {
      const auto base = type_of(2, type.n_corners == 6 ? 6 : type.n_nodes == 20 ? 8 : 9);
      const auto reference = test::reference_cell<2>(base);
      const auto moved = test::random_cell<2>(base, radius, random);
      auto column = test::reference_cell<3>(type);
      for (auto& point : column)
        for (std::size_t k = 0; k < reference.size(); ++k)
          if ((reference[k] - point.head<2>()).norm() < 1e-12) {
            point.head<2>() = moved[k];
            break;
          }
      return column;
    }
  return test::random_cell<dim>(type, radius, random);
}

/// A criterion that looks at the nodes only accepts cells that are invalid elsewhere.
TEST_P(CurvedCells, AreRefusedWhereNodesDoNotShowThatTheyAreInvalid) {
  with_dimension(GetParam().dim, [&]<int dim>() {
    test::Random random(2);
    const auto nodes =
        test::gradients_at(GetParam(), shape_functions(dim, GetParam().n_nodes).nodes());
    const auto samples =
        test::gradients_at(GetParam(), test::reference_samples(GetParam(), 100, random));
    const auto positive_at = [](const auto& cell, const test::Gradients& points) {
      return std::all_of(points.begin(), points.end(), [&](const auto& gradients) {
        return test::jacobian(cell, gradients) > 0.0;
      });
    };
    std::size_t n_deceptive = 0;
    for (int i = 0; i < 1000 && n_deceptive < 3; ++i) {
      const auto cell = random_cell_or_column<dim>(GetParam(), random);
      if (!positive_at(cell, nodes) || positive_at(cell, samples)) continue;
      ++n_deceptive;
      EXPECT_FALSE(proven_valid(cell));
    }
    EXPECT_EQ(n_deceptive, 3u);
  });
}

TEST_P(CurvedCells, AreProvenValidAtAnyPlaceSizeAndThickness) {
  with_dimension(GetParam().dim, [&]<int dim>() {
    test::Random random(3);
    const auto cell = test::random_cell<dim>(GetParam(), 0.02, random);
    const Interval ratio = scaled_jacobian<dim>(std::span<const Point<dim>>(cell), 1e-4);
    Eigen::Matrix<double, dim, dim> turn = Eigen::Matrix<double, dim, dim>::Identity();
    turn.template topLeftCorner<2, 2>() = Eigen::Rotation2D<double>(0.7).toRotationMatrix();
    for (const double size : {1e-200, 1e-100, 1.0, 1e100, 1e150})
      for (const double thickness : {1.0, 1e-6})
        for (const double offset : {0.0, 1e3}) {
          auto moved = cell;
          for (auto& point : moved) {
            point[0] *= thickness;
            point = size * (turn * point + offset * Point<dim>::Ones()).eval();
          }
          // Far from the origin, thin cells have no precise shape.
          if (offset > 0.0 && thickness < 1.0) continue;
          EXPECT_TRUE(proven_valid(moved)) << size << ' ' << thickness << ' ' << offset;
          const auto same = scaled_jacobian<dim>(std::span<const Point<dim>>(moved), 1e-4);
          EXPECT_NEAR(same.lower, ratio.lower, 5e-3);
        }
  });
}

/// A thin linear image of the reference element: all coordinates are exact (but for the middle of
/// TRI7), and so is its det J.
TEST_P(CurvedCells, HaveCoefficientsWithinTheBoundOfRoundingErrors) {
  with_dimension(GetParam().dim, [&]<int dim>() {
    constexpr double thickness = 0x1p-20;
    auto cell = test::reference_cell<dim>(GetParam());
    for (auto& point : cell) {
      const double x = point[0], y = point[1];
      point[0] = x + y;
      point[1] = x + (1.0 + thickness) * y;
      if (dim == 3) point[dim - 1] += y;
    }
    const JacobianPolynomial<dim> jacobian(cell);
    const double exact = std::ldexp(thickness, -jacobian.exponent());
    EXPECT_LT(jacobian.error(), 0.01 * exact);
    for (const double coefficient : jacobian.coefficients())
      EXPECT_NEAR(coefficient, exact, jacobian.error());
    EXPECT_TRUE(proven_valid(cell));
  });
}

TEST_P(CurvedCells, AreNotValidIfInvertedDegenerateOrNotFinite) {
  with_dimension(GetParam().dim, [&]<int dim>() {
    const auto good = test::reference_cell<dim>(GetParam());
    ASSERT_TRUE(proven_valid(good));
    const auto ratio_of = [](const std::vector<Point<dim>>& cell) {
      return scaled_jacobian<dim>(std::span<const Point<dim>>(cell), 1e-3);
    };
    auto inverted = good, flat = good, point = good;
    for (auto& x : inverted) x[0] = -x[0];
    for (auto& x : flat) x[0] = 0.5 * x[1];
    for (auto& x : point) x.setConstant(0.1);
    for (const auto& cell : {inverted, flat, point}) {
      EXPECT_FALSE(proven_valid(cell));
      EXPECT_EQ(curved_mean_ratio<dim>(std::span<const Point<dim>>(cell)), 0.0);
    }
    EXPECT_EQ(ratio_of(inverted).lower, -1.0);
    EXPECT_NEAR(ratio_of(inverted).upper, -1.0, 1e-6);
    for (const double value : {std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::quiet_NaN(), 1e308}) {
      for (std::size_t k = 0; k < good.size(); ++k) {
        auto bad = good;
        bad[k][1] = value;
        if (value == 1e308) bad[(k + 1) % good.size()][1] = -value;  // the difference overflows
        EXPECT_FALSE(proven_valid(bad)) << k;
      }
      auto bad = good;
      bad[1][0] = std::numeric_limits<double>::quiet_NaN();
      EXPECT_EQ(bounds_of(bad, 1e-3).minimum.lower, -std::numeric_limits<double>::infinity());
      EXPECT_EQ(ratio_of(bad).lower, -1.0);
      EXPECT_EQ(ratio_of(bad).upper, 1.0);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Types, CurvedCells, testing::ValuesIn(second_order_types),
                         [](const auto& info) { return name_of(info.param); });

/// With the midside node of the edge from 0 to 1 at m, det J = 1 + 4 (m - 1/2) (1 - 2x - y - z).
template <int dim>
std::vector<Point<dim>> simplex_with_moved_midside_node(double m) {
  auto points = test::reference_cell<dim>(type_of(dim, dim == 2 ? 6 : 10));
  points[dim + 1][0] = m;
  return points;
}

TEST(QuadraticSimplices, HaveTheExactBounds) {
  const auto check = [](const auto& cell, double m) {
    const auto [minimum, maximum] = bounds_of(cell, 0.0);
    EXPECT_NEAR(minimum.lower, 4.0 * m - 1.0, 1e-10);
    EXPECT_NEAR(minimum.upper, 4.0 * m - 1.0, 1e-10);
    EXPECT_NEAR(maximum.lower, 3.0 - 4.0 * m, 1e-10);
    EXPECT_NEAR(maximum.upper, 3.0 - 4.0 * m, 1e-10);
    EXPECT_EQ(proven_valid(cell), m > 0.25);
  };
  for (const double m : {0.0, 0.2, 0.25, 0.2500001, 0.26, 0.4}) {
    check(simplex_with_moved_midside_node<2>(m), m);
    check(simplex_with_moved_midside_node<3>(m), m);
  }
}

/// det J is 0 at a corner: rounding may make it positive, which is no proof.
TEST(QuadraticSimplices, AreNotValidWithMidsideNodesAtTheQuarterPoint) {
  test::Random random(4);
  const auto at_corner = shape_functions(3, 10).gradients(Point<3>::Zero());
  int n_seem_positive = 0;
  for (int i = 0; i < 100; ++i) {
    auto cell = simplex_with_moved_midside_node<3>(0.25);
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(random(), random(), random(), random()).normalized();
    for (auto& point : cell) point = turn * point + Point<3>(0.1, 0.2, 0.3);
    if (test::jacobian(cell, at_corner) > 0.0) ++n_seem_positive;
    EXPECT_FALSE(proven_valid(cell));
  }
  EXPECT_GT(n_seem_positive, 10);
}

/// A quadrilateral that is valid only as the minimum lies inside, where it needs bisections.
TEST(CurvedBounds, AreDecidedByBisectionWhereCoefficientsAreNegative) {
  int n_bisected = 0;
  test::Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const auto cell = test::random_cell<2>(type_of(2, 9), 0.15, random);
    const JacobianPolynomial<2> jacobian(cell);
    const auto coefficients = jacobian.coefficients();
    if (proven_valid(cell) && *std::min_element(coefficients.begin(), coefficients.end()) <= 0.0)
      ++n_bisected;
  }
  EXPECT_GT(n_bisected, 10);
}

// --- Quality and size ----------------------------------------------------------------------------

class StraightCells : public CurvedCells {};

TEST_P(StraightCells, HaveTheMeanRatioAndTheSizeOfTheirCorners) {
  with_dimension(GetParam().dim, [&]<int dim>() {
    test::Random random(6);
    int n_valid = 0;
    for (int i = 0; i < 100; ++i) {
      const auto cell = test::random_straight_cell<dim>(GetParam(), 0.15, random);
      const std::span<const Point<dim>> points(cell);
      const auto mesh = mesh_of_one_cell<dim>(corners_of(GetParam(), cell));
      EXPECT_NEAR(curved_cell_size<dim>(points), signed_cell_size(mesh, 0), 1e-13);
      if (!proven_valid(cell)) continue;
      ++n_valid;
      EXPECT_NEAR(curved_mean_ratio<dim>(points), cell_mean_ratio(mesh, 0), 1e-14);
    }
    EXPECT_GT(n_valid, 50);
  });
}

TEST_P(StraightCells, HaveTheScaledJacobianOneIfItIsConstant) {
  with_dimension(GetParam().dim, [&]<int dim>() {
    test::Random random(7);
    Eigen::Matrix<double, dim, dim> map = Eigen::Matrix<double, dim, dim>::Identity();
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) map(i, j) += 0.3 * random();
    auto cell = test::reference_cell<dim>(GetParam());
    for (auto& point : cell) point = (map * point).eval();
    const auto [lower, upper] = scaled_jacobian<dim>(std::span<const Point<dim>>(cell), 1e-3);
    EXPECT_NEAR(lower, 1.0, 1e-6);
    EXPECT_EQ(upper, 1.0);
  });
}

INSTANTIATE_TEST_SUITE_P(Types, StraightCells, testing::ValuesIn(second_order_types),
                         [](const auto& info) { return name_of(info.param); });

/// If a node of a cell's side moves outwards by h, the size grows by h times the integral of its
/// shape function over that side.
TEST(CurvedCellSize, GrowsByTheIntegralOfAShapeFunction) {
  constexpr double h = 0.07;
  const struct {
    int dim;
    std::size_t n_nodes, node;
    int direction;
    double size, integral;
  } cases[] = {
      {2, 6, 3, 1, 1 / 2.0, 2 / 3.0},   {2, 7, 3, 1, 1 / 2.0, 2 / 3.0},
      {2, 8, 4, 1, 1, 2 / 3.0},         {2, 9, 4, 1, 1, 2 / 3.0},
      {3, 10, 4, 2, 1 / 6.0, 1 / 6.0},  {3, 13, 5, 2, 1 / 3.0, 1 / 3.0},
      {3, 14, 5, 2, 1 / 3.0, 1 / 9.0},  {3, 14, 13, 2, 1 / 3.0, 4 / 9.0},
      {3, 15, 6, 2, 1 / 2.0, 1 / 6.0},  {3, 15, 6, 1, 1 / 2.0, 1 / 3.0},
      {3, 18, 6, 2, 1 / 2.0, 1 / 6.0},  {3, 18, 6, 1, 1 / 2.0, 1 / 9.0},
      {3, 18, 15, 1, 1 / 2.0, 4 / 9.0}, {3, 20, 8, 2, 1, 1 / 3.0},
      {3, 27, 8, 2, 1, 1 / 9.0},        {3, 27, 20, 2, 1, 4 / 9.0},
  };
  for (const auto& c : cases)
    with_dimension(c.dim, [&]<int dim>() {
      auto cell = test::reference_cell<dim>(type_of(dim, c.n_nodes));
      EXPECT_NEAR(curved_cell_size<dim>(std::span<const Point<dim>>(cell)), c.size, 1e-14);
      cell[c.node][c.direction] -= h;
      EXPECT_NEAR(curved_cell_size<dim>(std::span<const Point<dim>>(cell)), c.size + h * c.integral,
                  1e-14)
          << c.n_nodes << ' ' << c.node;
    });
}

/// Sectors of a disk with midside nodes on the circle. Their sides are parabolas: a segment has two
/// thirds of its chord times its height. So the error of the area decreases with the fourth power.
TEST(CurvedCellSize, OfADiskIsThatOfParabolas) {
  double former_error = 0.0;
  for (const int n : {8, 16}) {
    const double half = std::numbers::pi / n;
    double area = 0.0;
    for (int k = 0; k < n; ++k) {
      const auto on_circle = [&](double turn) -> Point<2> {
        return {std::cos(turn * half), std::sin(turn * half)};
      };
      const Point<2> a = on_circle(2 * k), b = on_circle(2 * k + 2);
      const std::vector<Point<2>> cell{{0, 0}, a, b, 0.5 * a, on_circle(2 * k + 1), 0.5 * b};
      EXPECT_TRUE(proven_valid(cell));
      area += curved_cell_size<2>(std::span<const Point<2>>(cell));
    }
    const double segment = 2.0 / 3.0 * 2.0 * std::sin(half) * (1.0 - std::cos(half));
    EXPECT_NEAR(area, n * (0.5 * std::sin(2.0 * half) + segment), 1e-14);
    const double error = std::numbers::pi - area;
    if (former_error > 0.0) {
      EXPECT_NEAR(former_error / error, 16.0, 0.5);
    }
    former_error = error;
  }
}

/// Two edges of a regular triangle are bent, so that their tangents at the common corner form a
/// right angle. The others stay as they are, up to the same turn.
TEST(CurvedMeanRatio, IsThatOfTheTangentsAtTheCorners) {
  const double s = 0.5 * std::numbers::sqrt3;
  std::vector<Point<2>> cell{{0, 0}, {1, 0}, {0.5, s}, {0.5, 0}, {0.75, 0.5 * s}, {0.25, 0.5 * s}};
  const std::span<const Point<2>> points(cell);
  EXPECT_NEAR(curved_mean_ratio<2>(points), 1.0, 1e-15);
  cell[3] += Point<2>(0.0, -0.05);  // tangents (1, -0.2) at node 0 and (-1, -0.2) at node 1
  // 2 det(S) / |S|^2 = 2 sin(60) det / (a^2 + b^2 - 2 cos(60) a.b), det = s + 0.1, a.b = 0.5 - 0.2
  // s
  const double bent = 2.0 * s * (s + 0.1) / (1.0 + 1.04 - (0.5 - 0.2 * s));
  EXPECT_NEAR(curved_mean_ratio<2>(points), (2.0 * bent + 1.0) / 3.0, 1e-15);
}

// --- Meshes --------------------------------------------------------------------------------------

/// The same mesh with midside nodes in every cell but each third one, moved by up to `radius`.
template <int dim>
Mesh<dim> with_midside_nodes(const Mesh<dim>& linear, double radius, bool with_faces,
                             bool with_linear_cells) {
  const Topology& old = linear.topology();
  auto points = linear.copied_coordinates();
  test::Random random(8);
  std::map<std::vector<NodeIndex>, NodeIndex> at;  // edges and faces by their corners
  const auto node_at = [&](std::vector<NodeIndex> corners) {
    std::sort(corners.begin(), corners.end());
    const auto [found, is_new] = at.insert({corners, static_cast<NodeIndex>(points.size())});
    if (is_new) {
      Point<dim> sum = Point<dim>::Zero();
      for (const NodeIndex corner : corners) sum += linear.coordinates()[corner];
      sum /= static_cast<double>(corners.size());
      for (int d = 0; d < dim; ++d) sum[d] += radius * random();
      points.push_back(sum);
    }
    return found->second;
  };
  auto midside = std::make_shared<MidsideNodes>();
  for (CellIndex c = 0; c < old.n_cells(); ++c) {
    const auto nodes = old.cell_nodes(c);
    std::vector<NodeIndex> row;
    if (!with_linear_cells || c % 3 != 0) {
      for_each_edge(dim, nodes.size(), [&](std::size_t a, std::size_t b) {
        row.push_back(node_at({nodes[a], nodes[b]}));
      });
      if (with_faces && dim == 3)
        for_each_quadrilateral_face(nodes.size(), [&](const LocalFace& face) {
          std::vector<NodeIndex> corners;
          for (const auto k : face.indices()) corners.push_back(nodes[k]);
          row.push_back(node_at(corners));
        });
      if (with_faces && nodes.size() == (dim == 2 ? 4 : 8))
        row.push_back(node_at({nodes.begin(), nodes.end()}));
    }
    midside->of_cells.append(row);
  }
  MeshLabels labels;
  labels.midside = midside;
  return {std::make_shared<const Topology>(dim, points.size(), old.cells(), std::nullopt, labels),
          points, nullptr, linear.shared_targets()};
}

template <int dim>
void check_mesh(const Mesh<dim>& linear) {
  for (const bool with_faces : {false, true}) {
    const auto mesh = with_midside_nodes(linear, 0.03, with_faces, true);
    const auto ratios = curved_mean_ratios(mesh), jacobians = scaled_jacobians(mesh),
               sizes = curved_cell_sizes(mesh);
    for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
      std::vector<Point<dim>> points;
      for (const NodeIndex node : mesh.topology().cell_nodes(c))
        points.push_back(mesh.coordinates()[node]);
      const auto midside = mesh.topology().midside_nodes(c);
      if (midside.empty()) {
        EXPECT_EQ(ratios[c], cell_mean_ratio(mesh, c));
        EXPECT_EQ(sizes[c], signed_cell_size(mesh, c));
        EXPECT_GT(jacobians[c], 0.0);
        EXPECT_LE(jacobians[c], 1.0);
        continue;
      }
      for (const NodeIndex node : midside) points.push_back(mesh.coordinates()[node]);
      const std::span<const Point<dim>> row(points);
      EXPECT_EQ(ratios[c], curved_mean_ratio<dim>(row));
      EXPECT_EQ(jacobians[c], scaled_jacobian<dim>(row, 1e-3).lower);
      EXPECT_EQ(sizes[c], curved_cell_size<dim>(row));
      EXPECT_GT(ratios[c], 0.0);
    }
    const int before = n_threads();
    for (const int threads : {1, 3}) {
      set_n_threads(threads);
      EXPECT_EQ(curved_mean_ratios(mesh), ratios);
      EXPECT_EQ(scaled_jacobians(mesh), jacobians);
      EXPECT_EQ(curved_cell_sizes(mesh), sizes);
    }
    set_n_threads(before);
  }
}

TEST(CurvedMeshes, HaveTheQualityOfTheirCells) {
  check_mesh(test::grid_mesh(6, test::GridCells::mixed));
  check_mesh(test::box_mesh(2, 2, 4, test::BoxCells::mixed));
}

TEST(CurvedMeshes, HaveTheVolumeOfTheirBoundary) {
  // Nodes inside move; those on the boundary stay.
  auto mesh = with_midside_nodes(test::box_mesh(3, 3, 4, test::BoxCells::mixed), 0.0, true, false);
  test::Random random(9);
  for (auto& x : mesh.coordinates()) {
    const double inside = std::min({x[0], 3 - x[0], x[1], 3 - x[1], x[2], 4 - x[2], 0.05});
    for (int d = 0; d < 3; ++d) x[d] += inside * random();
  }
  const auto sizes = curved_cell_sizes(mesh);
  EXPECT_NEAR(std::accumulate(sizes.begin(), sizes.end(), 0.0), 36.0, 1e-12);
}

TEST(CurvedMeshes, AreRelativeToTheirTargets) {
  const auto check = []<int dim>(const Mesh<dim>& linear, const Mesh<dim>& reference) {
    const Mesh<dim> with_targets(linear.shared_topology(), linear.copied_coordinates(), nullptr,
                                 targets_of(reference, TargetKind::shape_and_size));
    const auto curved = curved_mean_ratios(with_midside_nodes(with_targets, 0.0, true, false));
    const auto straight = cell_mean_ratios(with_targets), plain = cell_mean_ratios(linear);
    ASSERT_NE(straight, plain);
    for (CellIndex c = 0; c < linear.n_cells(); ++c) EXPECT_NEAR(curved[c], straight[c], 1e-13);
  };
  auto planar = test::grid_mesh(4, test::GridCells::mixed);
  test::distort(planar, 0.2, 1);
  check(test::grid_mesh(4, test::GridCells::mixed), planar);
  const auto box = test::box_mesh(2, 2, 4, test::BoxCells::mixed);
  auto thin = box;
  for (auto& x : thin.coordinates()) x[2] *= 0.5;
  check(box, thin);
}

TEST(CurvedMeshes, OfSurfacesHaveTheQualityOfStraightCells) {
  const auto plan =
      with_midside_nodes(test::grid_mesh(3, test::GridCells::mixed), 0.03, false, true);
  std::vector<Point<3>> points;
  for (const auto& p : plan.coordinates()) points.emplace_back(p.x(), p.y(), 0.1 * p.x() * p.x());
  const auto surface = make_surface_mesh(plan.topology().cells(), points, plan.topology().labels());
  ASSERT_NE(surface.topology().midside(), nullptr);
  EXPECT_EQ(curved_mean_ratios(surface), cell_mean_ratios(surface));
}

TEST(CurvedMeshes, HavePolygonsWithoutAScaledJacobian) {
  const auto mesh = test::pentagon_mesh();
  EXPECT_EQ(curved_mean_ratios(mesh), cell_mean_ratios(mesh));
  for (const double ratio : scaled_jacobians(mesh)) EXPECT_TRUE(std::isnan(ratio));
}

}  // namespace
}  // namespace smoothfem
