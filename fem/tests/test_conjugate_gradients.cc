// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear_algebra/conjugate_gradients.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "fem/linear_algebra/lanczos_eigenvalues.h"
#include "fem/tests/random_vector.h"

namespace smoothfem {
namespace {

/// Tridiagonal (-1, 2, -1) with a diagonal scaling that Jacobi removes.
SparseMatrix scaled_laplacian(int n, double ratio) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto scale = [&](int i) { return std::pow(ratio, static_cast<double>(i) / n); };
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 2.0 * scale(i) * scale(i));
    if (i + 1 < n) {
      entries.emplace_back(i, i + 1, -scale(i) * scale(i + 1));
      entries.emplace_back(i + 1, i, -scale(i) * scale(i + 1));
    }
  }
  SparseMatrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

TEST(ConjugateGradients, SolvesToTheToleranceInNoMoreIterationsThanUnknowns) {
  constexpr int n = 40;
  const SparseMatrix matrix = scaled_laplacian(n, 1.0);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, 1.0, 3.0);
  Eigen::VectorXd x;
  const auto result =
      conjugate_gradients(SlicedMatrix(matrix), b, x, {.tolerance = 1e-10, .max_iterations = 1000});
  EXPECT_EQ(result.end, ConjugateGradientsEnd::converged);
  EXPECT_LE(result.iterations, static_cast<std::size_t>(n));
  EXPECT_LE((b - matrix * x).norm(), 2e-10 * b.norm());
  EXPECT_LT((x - Eigen::MatrixXd(matrix).ldlt().solve(b)).norm(), 1e-7 * x.norm());
}

TEST(ConjugateGradients, DoesNotStopOneIterationTooEarly) {
  const SparseMatrix matrix = scaled_laplacian(60, 3.0);
  const Eigen::VectorXd b = random_vector(60, 1);
  Eigen::VectorXd x;
  const auto full =
      conjugate_gradients(SlicedMatrix(matrix), b, x, {.tolerance = 1e-8, .max_iterations = 1000});
  ASSERT_EQ(full.end, ConjugateGradientsEnd::converged);
  EXPECT_LE((b - matrix * x).norm(), 1.001e-8 * b.norm());
  const auto cut = conjugate_gradients(SlicedMatrix(matrix), b, x,
                                       {.tolerance = 1e-8, .max_iterations = full.iterations - 1});
  EXPECT_EQ(cut.end, ConjugateGradientsEnd::iteration_limit);
  EXPECT_GT((b - matrix * x).norm(), 0.999e-8 * b.norm());
}

TEST(ConjugateGradients, LanczosNumbersHaveTheExtremeEigenvalues) {
  const SparseMatrix matrix = scaled_laplacian(30, 2.0);
  Eigen::VectorXd x;
  const auto result = conjugate_gradients(SlicedMatrix(matrix), random_vector(30, 1), x,
                                          {.tolerance = 1e-12, .max_iterations = 1000});
  const auto [smallest, largest] = extreme_ritz_values(result.lanczos);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> dense{Eigen::MatrixXd(matrix)};
  EXPECT_NEAR(largest.value / dense.eigenvalues().maxCoeff(), 1.0, 1e-8);
  EXPECT_NEAR(smallest.value / dense.eigenvalues().minCoeff(), 1.0, 1e-8);
}

TEST(ConjugateGradients, JacobiRemovesADiagonalScaling) {
  const SparseMatrix scaled = scaled_laplacian(50, 1e3), plain = scaled_laplacian(50, 1.0);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(50);
  Eigen::VectorXd x;
  const auto none =
      conjugate_gradients(SlicedMatrix(scaled), b, x, {.tolerance = 1e-8, .max_iterations = 10000});
  const auto jacobi =
      conjugate_gradients(SlicedMatrix(scaled), b, x, {.tolerance = 1e-8, .max_iterations = 10000},
                          jacobi_preconditioner(SlicedMatrix(scaled)));
  EXPECT_LT((b - scaled * x).norm(), 1.1e-8 * b.norm());
  EXPECT_LT(jacobi.iterations, none.iterations / 2);
  EXPECT_LE(jacobi.iterations, 2 * conjugate_gradients(SlicedMatrix(plain), b, x,
                                                       {.tolerance = 1e-8, .max_iterations = 1000})
                                       .iterations);
}

TEST(ConjugateGradients, ZeroRightHandSideNeedsNoIteration) {
  Eigen::VectorXd x;
  const auto result =
      conjugate_gradients(SlicedMatrix(scaled_laplacian(5, 1.0)), Eigen::VectorXd::Zero(5), x,
                          {.tolerance = 1e-8, .max_iterations = 10});
  EXPECT_EQ(result.end, ConjugateGradientsEnd::converged);
  EXPECT_EQ(result.iterations, 0U);
  EXPECT_EQ(x.norm(), 0.0);
}

TEST(ConjugateGradients, StopsAtItsTimeLimit) {
  const SparseMatrix matrix = scaled_laplacian(60, 3.0);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(60);
  Eigen::VectorXd x;
  const auto result = conjugate_gradients(SlicedMatrix(matrix), b, x, {.max_seconds = 0.0});
  EXPECT_EQ(result.end, ConjugateGradientsEnd::time_limit);
  EXPECT_EQ(result.iterations, 1U);
  EXPECT_GT(x.norm(), 0.0);
}

TEST(ExtremeRitzValues, AgreeWithDenseEigenvaluesOfRandomTridiagonalMatrices) {
  test::Random random(1);
  for (const int n : {1, 2, 3, 10, 200}) {
    LanczosMatrix matrix;
    for (int i = 0; i < n; ++i) {
      // Diagonally dominant, so positive definite.
      matrix.diagonal.push_back(2.1 + random());
      matrix.off_diagonal.push_back(0.5 + 0.05 * random());
    }
    const Eigen::Map<const Eigen::VectorXd> diagonal(matrix.diagonal.data(), n);
    const Eigen::Map<const Eigen::VectorXd> off_diagonal(matrix.off_diagonal.data(), n - 1);
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> dense;
    dense.computeFromTridiagonal(diagonal, off_diagonal);
    const auto [smallest, largest] = extreme_ritz_values(matrix);
    const auto expect_pair = [&](const RitzValue& found, Eigen::Index k) {
      EXPECT_NEAR(found.value / dense.eigenvalues()[k], 1.0, 1e-13) << "of " << n;
      const double last = matrix.off_diagonal.back() * dense.eigenvectors()(n - 1, k);
      EXPECT_NEAR(found.residual, std::abs(last) / dense.eigenvalues()[k], 1e-10) << "of " << n;
    };
    expect_pair(smallest, 0);
    expect_pair(largest, n - 1);
  }
}

TEST(SlicedMatrix, MultipliesAsTheMatrixItWasMadeOf) {
  // Rows of very different lengths, and a number of rows that is not a multiple of the lanes.
  for (const int n : {1, 3, 4, 37, 301}) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i)
      for (int j = i % 7; j < n; j += 1 + (i * i) % 11) entries.emplace_back(i, j, i - 0.3 * j);
    SparseMatrix matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    SlicedMatrix sliced(matrix);
    Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, -1.0, 2.0);
    Eigen::VectorXd y(n);
    const double product = sliced.multiply(x, y);
    EXPECT_NEAR(product, x.dot(y), 1e-12 * x.norm() * y.norm());
    EXPECT_LT((y - Eigen::MatrixXd(matrix) * x).norm(), 1e-12 * (1.0 + y.norm()));
    matrix *= 2.0;
    sliced.set_values(matrix);
    Eigen::VectorXd twice(n);
    sliced.multiply(x, twice);
    EXPECT_EQ(twice, 2.0 * y);
  }
}

}  // namespace
}  // namespace smoothfem
