// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "smoothing/loop/smooth.h"
#include "smoothing/optimization/block_conjugate_gradients.h"
#include "smoothing/optimization/feasible_movement.h"
#include "smoothing/optimization/node_terms.h"
#include "smoothing/optimization/vertex_descent.h"
#include "smoothing/optimization/volume_cell_derivatives.h"
#include "smoothing/simd/cells.h"
#include "smoothing/tests/dense_derivatives.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using test::box_mesh;
using test::BoxCells;
using test::dense_derivatives;

constexpr std::array all_kinds{BoxCells::tetrahedra, BoxCells::pyramids, BoxCells::prisms,
                               BoxCells::hexahedra, BoxCells::mixed};

VolumeMesh distorted_box(std::uint32_t n, BoxCells kind, double radius, std::uint64_t seed) {
  auto mesh = box_mesh(n, n, kind == BoxCells::mixed ? 2 * n : n, kind);
  test::distort(mesh, radius, seed);
  return mesh;
}

/// Rounding error of matrices, which are stored in single precision, relative to their norm.
constexpr double matrix_rounding = 1e-6;

/// Edges of the regular element from each of its corners as columns, from its nodes.
Eigen::Matrix3d regular_corner(std::size_t n_nodes, const LocalSimplex& corner) {
  const double s = 0.5 * std::sqrt(3.0), h = std::sqrt(2.0 / 3.0), p = std::sqrt(0.5);
  std::vector<Point<3>> x;
  if (n_nodes == 4)
    x = {{0, 0, 0}, {1, 0, 0}, {0.5, s, 0}, {0.5, s / 3.0, h}};
  else if (n_nodes == 5)
    x = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, p}};
  else if (n_nodes == 6)
    x = {{0, 0, 0}, {1, 0, 0}, {0.5, s, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, s, 1}};
  else
    x = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  Eigen::Matrix3d edges;
  for (int i = 0; i < 3; ++i) edges.col(i) = x[corner[i + 1]] - x[corner[0]];
  return edges;
}

/// Computes the objective by its definition.
double plain_objective(const VolumeMesh& mesh) {
  double sum = 0.0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto nodes = mesh.topology().cell_nodes(c);
    const auto& corners = volume_element(nodes.size()).corners;
    double mean = 0.0;
    for (const LocalSimplex& corner : corners) {
      Eigen::Matrix3d edges;
      for (int i = 0; i < 3; ++i)
        edges.col(i) =
            mesh.coordinates()[nodes[corner[i + 1]]] - mesh.coordinates()[nodes[corner[0]]];
      const Eigen::Matrix3d s = edges * regular_corner(nodes.size(), corner).inverse();
      mean += s.squaredNorm() / (3.0 * std::pow(s.determinant(), 2.0 / 3.0)) /
              static_cast<double>(corners.size());
    }
    sum += mean * mean;
  }
  return sum;
}

TEST(VolumeShapeObjective, AgreesWithItsDefinition) {
  for (const BoxCells kind : all_kinds) {
    const auto mesh = distorted_box(3, kind, 0.4, 5);
    const double expected = plain_objective(mesh);
    const ShapeObjective<3> objective(mesh.shared_topology());
    EXPECT_NEAR(objective.value(mesh.copied_coordinates()), expected, 1e-12 * expected);
  }
}

TEST(VolumeShapeObjective, IsInfiniteForInvalidCells) {
  for (const BoxCells kind : all_kinds) {
    auto mesh = box_mesh(2, 2, 4, kind);
    const NodeIndex node = mesh.topology().free_nodes()[0];
    mesh.coordinates()[node] += Point<3>(0.0, 0.0, 3.0);
    const ShapeObjective<3> objective(mesh.shared_topology());
    EXPECT_TRUE(std::isinf(objective.value(mesh.coordinates())));
  }
}

TEST(VolumeShapeObjective, DerivativesAgreeWithCentralDifferences) {
  constexpr double h = 1e-6;
  for (const BoxCells kind : all_kinds) {
    auto mesh = distorted_box(3, kind, 0.25, 7);
    ShapeObjective<3> objective(mesh.shared_topology());
    const auto exact = dense_derivatives(objective, mesh, HessianModel::exact);
    const double scale = exact.hessian.norm();
    EXPECT_LT((exact.hessian - exact.hessian.transpose()).norm(), 1e-14 * scale);
    for (Eigen::Index j = 0; j < std::min<Eigen::Index>(exact.gradient.size(), 36); ++j) {
      double& here = mesh.coordinates()[mesh.topology().free_nodes()[j / 3]][j % 3];
      const double place = here;
      here = place + h;
      const double above = objective.value(mesh.coordinates());
      const auto gradient_above = dense_derivatives(objective, mesh, HessianModel::exact).gradient;
      here = place - h;
      const double below = objective.value(mesh.coordinates());
      const auto gradient_below = dense_derivatives(objective, mesh, HessianModel::exact).gradient;
      here = place;
      EXPECT_NEAR(exact.gradient[j], (above - below) / (2.0 * h), 1e-7 * scale);
      EXPECT_LT((exact.hessian.col(j) - (gradient_above - gradient_below) / (2.0 * h)).norm(),
                matrix_rounding * scale);
    }
  }
}

TEST(VolumeShapeObjective, ConvexModelHasTheGradientAndNoNegativeCurvature) {
  for (const BoxCells kind : all_kinds)
    for (const double radius : {0.1, 0.9}) {
      const auto mesh = distorted_box(3, kind, radius, 3);
      ShapeObjective<3> objective(mesh.shared_topology());
      const auto exact = dense_derivatives(objective, mesh, HessianModel::exact);
      const auto convex = dense_derivatives(objective, mesh, HessianModel::convex);
      EXPECT_EQ(exact.gradient, convex.gradient);
      const Eigen::VectorXd eigenvalues =
          convex.hessian.selfadjointView<Eigen::Lower>().eigenvalues();
      EXPECT_GT(eigenvalues.minCoeff(), -matrix_rounding * eigenvalues.maxCoeff());
    }
}

TEST(VolumeCellDerivatives, OfTheConvexModelArePositiveSemidefinite) {
  for (const BoxCells kind : all_kinds) {
    const auto mesh = distorted_box(3, kind, 0.9, 3);
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      with_corners<3>(mesh.topology().cell_nodes(c), mesh.coordinates().data(), [&](auto x) {
        constexpr std::size_t n = decltype(x)::extent;
        std::array<Vector3<double>, n> nodes;
        std::copy(x.begin(), x.end(), nodes.begin());
        const CellDerivatives<3, double, n> cell(std::span<const Vector3<double>, n>(nodes),
                                                 HessianModel::convex);
        Eigen::MatrixXd hessian(3 * n, 3 * n);  // its lower half
        for (std::size_t p = 0; p < n; ++p)
          for (std::size_t q = p; q < n; ++q)
            hessian.block<3, 3>(3 * q, 3 * p) =
                Eigen::Map<const Eigen::Matrix3d>(cell.hessian[node_pair(n, p, q)].entries.data())
                    .transpose();
        const Eigen::VectorXd eigenvalues = hessian.selfadjointView<Eigen::Lower>().eigenvalues();
        EXPECT_GT(eigenvalues.minCoeff(), -1e-12 * eigenvalues.maxCoeff()) << c;
      });
  }
}

TEST(VolumeConjugateGradients, SolveLikeADenseFactorization) {
  for (const BoxCells kind : all_kinds) {
    const auto mesh = distorted_box(3, kind, 0.2, 9);
    ShapeObjective<3> objective(mesh.shared_topology());
    BlockMatrix<3> matrix = objective.make_hessian();
    BlockVector<3> right = matrix.make_vector(), solution = right;
    objective.derivatives(mesh.coordinates(), HessianModel::convex, right, matrix);
    BlockConjugateGradients<3> solver;
    solver.prepare(matrix);
    EXPECT_FALSE(solver.solve(right, 1e-10, 1000, solution).negative_curvature);
    Eigen::VectorXd dense_right(3 * right.size()), found = dense_right;
    for (std::size_t i = 0; i < right.size(); ++i) {
      dense_right.segment<3>(3 * i) = right[i];
      found.segment<3>(3 * i) = solution[i];
    }
    const Eigen::VectorXd expected = test::dense_matrix(matrix).ldlt().solve(dense_right);
    EXPECT_LT((found - expected).norm(), matrix_rounding * expected.norm());
  }
}

/// Returns the smallest determinant of a cell's corners on the way, relative to that at the start.
double remaining(const VolumeMesh& mesh, const std::vector<Point<3>>& to, CellIndex c, double t) {
  const auto nodes = mesh.topology().cell_nodes(c);
  double least = 1e300;
  for (const LocalSimplex& corner : volume_element(nodes.size()).corners) {
    const auto determinant = [&](double s) {
      const auto place = [&](std::size_t k) -> Point<3> {
        const NodeIndex i = nodes[corner[k]];
        return (1.0 - s) * mesh.coordinates()[i] + s * to[i];
      };
      Eigen::Matrix3d edges;
      for (int i = 0; i < 3; ++i) edges.col(i) = place(i + 1) - place(0);
      return edges.determinant();
    };
    least = std::min(least, determinant(t) / determinant(0.0));
  }
  return least;
}

TEST(VolumeFeasibleFractions, StopJustBeforeADeterminantHasFallen) {
  constexpr double share = 0.9;
  for (const BoxCells kind : all_kinds) {
    const auto mesh = distorted_box(3, kind, 0.3, 2);
    auto to = mesh.copied_coordinates();
    test::Random random(3);
    for (const NodeIndex i : mesh.topology().free_nodes()) {
      const double dx = random(), dy = random(), dz = random();
      to[i] += 1.5 * Point<3>(dx, dy, dz);
    }
    std::vector<double> limits;
    feasible_fractions<3>(mesh.topology(), mesh.coordinates(), to, share, limits);
    std::size_t n_limited = 0, n_sharp = 0;
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
      double min_beyond = 1e300;
      for (const CellIndex c : mesh.topology().node_cells(i)) {
        for (int step = 0; step <= 50; ++step)
          EXPECT_GT(remaining(mesh, to, c, limits[i] * step / 50.0), 1.0 - share - 1e-9);
        min_beyond = std::min(min_beyond, remaining(mesh, to, c, 1.02 * limits[i]));
      }
      n_limited += limits[i] < 1.0;
      n_sharp += limits[i] < 1.0 && min_beyond < 1.0 - share;
    }
    EXPECT_GT(n_limited, 0u);
    EXPECT_GE(static_cast<double>(n_sharp), 0.95 * static_cast<double>(n_limited));
  }
}

template <std::size_t slot, std::size_t n>
void expect_node_terms_of_cell(const std::array<Vector3<double>, n>& nodes) {
  const std::span<const Vector3<double>, n> x(nodes);
  const CellDerivatives<3, double, n> cell(x, HessianModel::exact);
  const double mean = mean_inverse_mean_ratio(x);
  // Softness far below the determinants changes nothing.
  for (const double softness : {0.0, 1e-12}) {
    const auto terms = node_terms<slot, true>(x, softness);
    const auto& block = cell.hessian[node_pair(n, slot, slot)];
    EXPECT_NEAR(terms.value, mean * mean, 1e-13 * mean * mean);
    const Point<3> difference = point_of(terms.gradient) - point_of(cell.gradient[slot]);
    EXPECT_LE(difference.norm(), 1e-12 * point_of(terms.gradient).norm());
    for (std::size_t i = 0; i < 9; ++i)
      EXPECT_NEAR(terms.hessian.entries[i], block.entries[i], 1e-11 * std::abs(block.entries[0]));
  }
}

TEST(NodeTerms, AreThoseOfTheCell) {
  for (const BoxCells kind : all_kinds) {
    const auto mesh = distorted_box(3, kind, 0.3, 4);
    for (CellIndex c = 0; c < mesh.n_cells(); c += 7)
      with_corners<3>(mesh.topology().cell_nodes(c), mesh.coordinates().data(), [&](auto x) {
        constexpr std::size_t n = decltype(x)::extent;
        std::array<Vector3<double>, n> nodes;
        std::copy(x.begin(), x.end(), nodes.begin());
        expect_node_terms_of_cell<0>(nodes);
        if constexpr (n == 5) expect_node_terms_of_cell<4>(nodes);
      });
  }
}

TEST(NodeTerms, AreSmoothAndConvexWhereDeterminantsAreNot) {
  constexpr double softness = 0.3, h = 1e-6;
  test::Random random(5);
  for (int i = 0; i < 50; ++i) {
    std::array<Vector3<double>, 8> nodes;
    for (auto& node : nodes) {
      const double x = random(), y = random(), z = random();
      node = {x, y, z};
    }
    const auto value = [&](double dx) {
      auto moved = nodes;
      moved[0].x += dx;
      return node_terms<0, false>(std::span<const Vector3<double>, 8>(moved), softness).value;
    };
    const auto terms = node_terms<0, true>(std::span<const Vector3<double>, 8>(nodes), softness);
    EXPECT_NEAR(terms.gradient.x, (value(h) - value(-h)) / (2.0 * h), 1e-6 * (1.0 + terms.value));
    const Eigen::Matrix3d hessian = Eigen::Map<const Eigen::Matrix3d>(terms.hessian.entries.data());
    EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-13 * hessian.norm());
    const Eigen::Vector3d eigenvalues = hessian.selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_GT(eigenvalues.minCoeff(), -1e-13 * eigenvalues.maxCoeff());
  }
}

TEST(VertexDescent, LowersTheObjectiveInEverySweep) {
  for (const BoxCells kind : all_kinds) {
    auto mesh = distorted_box(5, kind, 0.9, 6);
    const ShapeObjective<3> objective(mesh.shared_topology());
    const VertexDescent<3> descent(mesh.topology());
    double last = objective.value(mesh.coordinates());
    for (int i = 0; i < 10; ++i) {
      descent.sweep(mesh.coordinates());
      const double value = objective.value(mesh.coordinates());
      EXPECT_LE(value, last * (1.0 + 1e-14));
      last = value;
    }
    auto optimal = mesh;
    Method<3> method = make_method<3>("global-optimization");
    smooth(optimal, method);
    EXPECT_LT(last, 1.1 * objective.value(optimal.coordinates()));
  }
}

double optimize(VolumeMesh& mesh, const std::string& tolerance = "1e-8") {
  Method<3> method = make_method<3>("global-optimization");
  method.set("tolerance", tolerance);
  smooth(mesh, method);
  return ShapeObjective<3>(mesh.shared_topology()).value(mesh.coordinates());
}

TEST(VolumeGlobalOptimization, LowersTheObjectiveInEveryIterationToAStationaryPoint) {
  for (const BoxCells kind : all_kinds)
    test::expect_descent_to_a_stationary_point(distorted_box(4, kind, 0.9, 6));
}

TEST(VolumeGlobalOptimization, ReachesTheSameMinimumFromDifferentStarts) {
  for (const BoxCells kind : all_kinds) {
    double lowest = 0.0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      auto mesh = box_mesh(6, 6, kind == BoxCells::mixed ? 12 : 6, kind);
      for (std::uint64_t sweep = 0; sweep < 4; ++sweep) test::distort(mesh, 0.6, 10 * seed + sweep);
      const double value = optimize(mesh);
      if (seed == 1) lowest = value;
      EXPECT_NEAR(value, lowest, 1e-6 * lowest);
    }
  }
}

TEST(VolumeGlobalOptimization, DoesNotDependOnTheNumberOfThreads) {
  const int before = n_threads();
  for (const BoxCells kind : {BoxCells::tetrahedra, BoxCells::hexahedra}) {
    std::optional<std::vector<Point<3>>> expected;
    for (const int n : {1, 2, 3, 8}) {
      set_n_threads(n);
      auto mesh = distorted_box(28, kind, 0.6, 8);  // enough for several threads in all parts
      Method<3> method = make_method<3>("global-optimization");
      method.set("start_sweeps", "1");
      method.set("max_iterations", "2");
      smooth(mesh, method);
      if (!expected) expected = mesh.copied_coordinates();
      EXPECT_EQ(mesh.copied_coordinates(), *expected) << n << " threads";
    }
  }
  set_n_threads(before);
}

TEST(VolumeGlobalOptimization, FollowsScale) {
  for (const BoxCells kind : all_kinds) {
    const auto mesh = distorted_box(4, kind, 0.9, 6);
    auto reference = mesh;
    const double value = optimize(reference);
    for (const double scale : {1e-9, 1e9}) {
      auto scaled = mesh;
      for (auto& p : scaled.coordinates()) p *= scale;
      EXPECT_NEAR(optimize(scaled), value, 1e-9 * value) << scale;
    }
  }
}

TEST(VolumeGlobalOptimization, RescuesBarelyValidElements) {
  for (const BoxCells kind : all_kinds) {
    const auto regular = distorted_box(5, kind, 0.1, 6);
    auto expected = regular;
    const double value = optimize(expected);
    auto mesh = regular;
    // Moves a node towards a neighbour until an element has almost collapsed.
    const NodeIndex node = mesh.topology().free_nodes()[mesh.topology().free_nodes().size() / 2];
    const Point<3> start = mesh.coordinates()[node];
    const Point<3> aim = mesh.coordinates()[mesh.topology().node_neighbours(node)[0]];
    double valid = 0.0, invalid = 2.0;
    const auto move_to = [&](double t) {
      mesh.coordinates()[node] = start + t * (aim - start);
      double lowest = 1.0;
      for (const CellIndex c : mesh.topology().node_cells(node))
        lowest = std::min(lowest, cell_mean_ratio(mesh, c));
      return lowest;
    };
    while (move_to(valid) > 1e-7 && invalid - valid > 1e-10) {
      const double middle = 0.5 * (valid + invalid);
      (move_to(middle) > 0.0 ? valid : invalid) = middle;
    }
    move_to(valid);
    EXPECT_NEAR(optimize(mesh), value, 1e-6 * value);
  }
}

}  // namespace
}  // namespace smoothfem
