// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "smoothing/loop/smooth.h"
#include "smoothing/optimization/block_conjugate_gradients.h"
#include "smoothing/optimization/feasible_movement.h"
#include "smoothing/optimization/shape_objective.h"
#include "smoothing/tests/dense_derivatives.h"
#include "smoothing/tests/planar_meshes.h"

namespace smoothfem {
namespace {

using test::dense_derivatives;
using test::grid_mesh;
using test::GridCells;

std::vector<PlanarMesh> distorted_meshes(double radius) {
  std::vector<PlanarMesh> all{
      grid_mesh(5, GridCells::triangles), grid_mesh(5, GridCells::quadrilaterals),
      grid_mesh(5, GridCells::mixed), test::pentagon_mesh(), test::honeycomb_mesh()};
  for (auto& mesh : all) test::distort(mesh, radius, 4);
  return all;
}

TEST(ShapeObjective, CountsRegularElements) {
  const auto squares = grid_mesh(4, GridCells::quadrilaterals);
  EXPECT_NEAR(ShapeObjective<2>(squares.shared_topology()).value(squares.copied_coordinates()),
              16.0, 1e-13);
  const auto triangles = grid_mesh(3, GridCells::triangles, true);
  EXPECT_NEAR(ShapeObjective<2>(triangles.shared_topology()).value(triangles.copied_coordinates()),
              18.0, 1e-13);
  const auto hexagons = test::honeycomb_mesh();
  EXPECT_NEAR(ShapeObjective<2>(hexagons.shared_topology()).value(hexagons.copied_coordinates()),
              37.0, 1e-12);
}

TEST(ShapeObjective, OfARightTriangleAndARectangle) {
  const auto triangle = test::make_mesh({{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}});
  EXPECT_NEAR(ShapeObjective<2>(triangle.shared_topology()).value(triangle.copied_coordinates()),
              4.0 / 3.0, 1e-14);
  const auto rectangle = test::make_mesh({{0, 0}, {2, 0}, {2, 1}, {0, 1}}, {{0, 1, 2, 3}});
  EXPECT_NEAR(ShapeObjective<2>(rectangle.shared_topology()).value(rectangle.copied_coordinates()),
              1.25 * 1.25, 1e-14);
}

TEST(ShapeObjective, IsInfiniteForInvalidCells) {
  auto mesh = grid_mesh(3, GridCells::mixed);
  mesh.coordinates()[5] = {2.5, 2.5};
  EXPECT_TRUE(std::isinf(ShapeObjective<2>(mesh.shared_topology()).value(mesh.coordinates())));
}

TEST(ShapeObjective, DerivativesAgreeWithCentralDifferences) {
  constexpr double h = 1e-6;
  for (auto& mesh : distorted_meshes(0.25)) {
    ShapeObjective<2> objective(mesh.shared_topology());
    const auto exact = dense_derivatives(objective, mesh, HessianModel::exact);
    const auto n = exact.gradient.size();
    for (Eigen::Index j = 0; j < n; ++j) {
      double& here = mesh.coordinates()[mesh.topology().free_nodes()[j / 2]][j % 2];
      const double position = here;
      here = position + h;
      const double above = objective.value(mesh.coordinates());
      const auto gradient_above = dense_derivatives(objective, mesh, HessianModel::exact).gradient;
      here = position - h;
      const double below = objective.value(mesh.coordinates());
      const auto gradient_below = dense_derivatives(objective, mesh, HessianModel::exact).gradient;
      here = position;
      const double scale = exact.hessian.norm();
      EXPECT_NEAR(exact.gradient[j], (above - below) / (2.0 * h), 1e-7 * scale);
      EXPECT_LT((exact.hessian.col(j) - (gradient_above - gradient_below) / (2.0 * h)).norm(),
                1e-7 * scale);
    }
  }
}

TEST(ShapeObjective, ConvexModelHasTheGradientAndNoNegativeCurvature) {
  for (const auto& mesh : distorted_meshes(0.9)) {
    ShapeObjective<2> objective(mesh.shared_topology());
    const auto exact = dense_derivatives(objective, mesh, HessianModel::exact);
    const auto convex = dense_derivatives(objective, mesh, HessianModel::convex);
    EXPECT_EQ(exact.gradient, convex.gradient);
    const Eigen::VectorXd eigenvalues =
        convex.hessian.selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_GT(eigenvalues.minCoeff(), -1e-12 * eigenvalues.maxCoeff());
  }
}

TEST(ShapeObjective, ConvexModelIsExactForRegularElements) {
  const auto mesh = grid_mesh(5, GridCells::triangles, true);
  ShapeObjective<2> objective(mesh.shared_topology());
  const auto exact = dense_derivatives(objective, mesh, HessianModel::exact);
  const auto convex = dense_derivatives(objective, mesh, HessianModel::convex);
  EXPECT_LT((exact.hessian - convex.hessian).norm(), 1e-12 * exact.hessian.norm());
}

TEST(BlockConjugateGradients, SolvesLikeADenseFactorization) {
  for (const auto& mesh : distorted_meshes(0.2)) {
    ShapeObjective<2> objective(mesh.shared_topology());
    BlockMatrix<2> matrix = objective.make_hessian();
    BlockVector<2> right = matrix.make_vector(), solution = right;
    objective.derivatives(mesh.coordinates(), HessianModel::convex, right, matrix);
    BlockConjugateGradients<2> solver;
    solver.prepare(matrix);
    const auto report = solver.solve(right, 1e-12, 1000, solution);
    EXPECT_FALSE(report.negative_curvature);
    EXPECT_GT(report.n_iterations, 0);
    const auto dense = dense_derivatives(objective, mesh, HessianModel::convex);
    const Eigen::VectorXd expected = dense.hessian.ldlt().solve(dense.gradient);
    for (Eigen::Index i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(solution[i / 2][i % 2], expected[i], 1e-8 * expected.norm());
  }
}

TEST(FeasibleFractions, StopWhereADeterminantHasFallen) {
  constexpr double share = 0.9;
  for (const auto& mesh : distorted_meshes(0.3)) {
    auto to = mesh.copied_coordinates();
    test::Random random(3);
    for (const NodeIndex i : mesh.topology().free_nodes()) {
      const double dx = random(), dy = random();
      to[i] += 2.0 * Point<2>(dx, dy);
    }
    std::vector<double> limits;
    const double smallest =
        feasible_fractions<2>(mesh.topology(), mesh.coordinates(), to, share, limits);
    /// The smallest determinant of a cell's corners, relative to that at the start.
    const auto remaining = [&](CellIndex c, double t) {
      const auto nodes = mesh.topology().cell_nodes(c);
      const auto n = nodes.size();
      const auto determinant = [&](std::size_t k, double s) {
        const auto position = [&](std::size_t l) -> Point<2> {
          const NodeIndex i = nodes[l % n];
          return (1.0 - s) * mesh.coordinates()[i] + s * to[i];
        };
        return cross(Point<2>(position(k + 1) - position(k)),
                     Point<2>(position(k + n - 1) - position(k)));
      };
      double least = 1e300;
      for (std::size_t k = 0; k < n; ++k)
        least = std::min(least, determinant(k, t) / determinant(k, 0.0));
      return least;
    };
    EXPECT_LT(smallest, 1.0);
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
      double least = 1e300;
      for (const CellIndex c : mesh.topology().node_cells(i)) {
        least = std::min(least, remaining(c, limits[i]));
        for (int step = 0; step < 50; ++step)
          EXPECT_GT(remaining(c, limits[i] * step / 50.0), 1.0 - share - 1e-9);
      }
      if (limits[i] < 1.0) {
        EXPECT_NEAR(least, 1.0 - share, 1e-9) << "node " << i;
      }
    }
  }
}

TEST(GlobalOptimization, LowersTheObjectiveInEveryIterationToAStationaryPoint) {
  for (const auto& mesh : distorted_meshes(0.9)) test::expect_descent_to_a_stationary_point(mesh);
}

TEST(GlobalOptimization, ReachesTheSameMinimumFromDifferentStarts) {
  for (const GridCells kind : {GridCells::triangles, GridCells::quadrilaterals, GridCells::mixed}) {
    double lowest = 0.0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      auto mesh = grid_mesh(16, kind);
      ShapeObjective<2> objective(mesh.shared_topology());
      for (std::uint64_t sweep = 0; sweep < 4; ++sweep) test::distort(mesh, 1.0, 10 * seed + sweep);
      ASSERT_GT(objective.value(mesh.coordinates()), 3.0 * static_cast<double>(mesh.n_cells()));
      Method<2> method = make_method<2>("global-optimization");
      smooth(mesh, method);
      const double value = objective.value(mesh.coordinates());
      if (seed == 1) lowest = value;
      EXPECT_NEAR(value, lowest, 1e-7 * lowest);
    }
  }
}

TEST(GlobalOptimization, ReachesTheSameMinimumWithStartSweeps) {
  for (const auto& mesh : distorted_meshes(0.9)) {
    const ShapeObjective<2> objective(mesh.shared_topology());
    auto swept = mesh, plain = mesh;
    Method<2> with = make_method<2>("global-optimization"),
              without = make_method<2>("global-optimization");
    with.set("start_sweeps", "5");
    smooth(swept, with);
    smooth(plain, without);
    const double expected = objective.value(plain.coordinates());
    EXPECT_NEAR(objective.value(swept.copied_coordinates()), expected, 1e-7 * expected);
  }
}

}  // namespace
}  // namespace smoothfem
