// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear_algebra/condition_number.h"

#include <Spectra/SymEigsSolver.h>

#include <Eigen/Eigenvalues>

#include <random>
#include <stdexcept>

#include "fem/linear_algebra/lanczos_eigenvalues.h"
#include "smoothing/base/interruption.h"

namespace smoothfem {

namespace {

/// Interface of linear operators for Spectra.
template <class Apply>
class Operator {
 public:
  using Scalar = double;
  Operator(Eigen::Index size, Apply apply) : size_(size), apply_(std::move(apply)) {}
  Eigen::Index rows() const { return size_; }
  Eigen::Index cols() const { return size_; }
  void perform_op(const double* in, double* out) const {
    let_interrupt();
    Eigen::Map<Eigen::VectorXd>(out, size_) = apply_(Eigen::Map<const Eigen::VectorXd>(in, size_));
  }

 private:
  Eigen::Index size_;
  Apply apply_;
};

/// Start vector: the same on every machine, with a component along every eigenvector.
Eigen::VectorXd start_vector(Eigen::Index size) {
  std::mt19937_64 random(1);
  Eigen::VectorXd v(size);
  for (auto& entry : v) entry = 0.5 + static_cast<double>(random() >> 11) * 0x1.0p-53;
  return v;
}

/// Computes the eigenvector of the operator's largest eigenvalue by restarted Lanczos; `vector`:
/// start and result. A start close to an eigenvector would stay at its eigenvalue even if that is
/// not the largest. So callers mix in a component along every eigenvector.
template <class Apply>
void largest_eigenvector(Eigen::Index size, const Apply& apply, Eigen::Index subspace,
                         Eigen::VectorXd& vector) {
  constexpr Eigen::Index max_restarts = 1000;
  Operator<Apply> op(size, apply);
  Spectra::SymEigsSolver<Operator<Apply>> solver(op, 1, std::min(subspace, size));
  try {
    solver.init(vector.data());
    solver.compute(Spectra::SortRule::LargestAlge, max_restarts, 0.1 * verified_residual);
    if (solver.info() == Spectra::CompInfo::Successful) vector = solver.eigenvectors().col(0);
  } catch (const std::runtime_error&) {  // of Spectra, for extreme numbers: the residual shows it
  } catch (const std::invalid_argument&) {
  }
}

double relative_residual(const SparseMatrix& matrix, const Eigen::VectorXd& v, double& eigenvalue) {
  const Eigen::VectorXd product = matrix * v;
  eigenvalue = v.dot(product) / v.squaredNorm();
  return (product - eigenvalue * v).norm() / (v.norm() * eigenvalue);
}

}  // namespace

ConditionNumber CholeskyConditionNumber::compute(const SparseMatrix& matrix) {
  const Eigen::Index n = matrix.rows();
  Eigen::VectorXd largest_vector = start_vector(n), smallest_vector = largest_vector;
  ConditionNumber result{.method = "lanczos+cholesky"};
  // The matrix is symmetric: its rows are its columns.
  const Eigen::Map<const ColumnMatrix> columns(n, n, matrix.nonZeros(), matrix.outerIndexPtr(),
                                               matrix.innerIndexPtr(), matrix.valuePtr());
  if (!analyzed_) factorization_.analyzePattern(columns);
  analyzed_ = true;
  let_interrupt();
  factorization_.factorize(columns);
  let_interrupt();
  if (factorization_.info() != Eigen::Success) return result;  // not positive definite

  largest_eigenvector(
      n, [&](const auto& v) -> Eigen::VectorXd { return matrix * v; }, 24, largest_vector);
  largest_eigenvector(
      n, [&](const auto& v) -> Eigen::VectorXd { return factorization_.solve(v); }, 12,
      smallest_vector);
  // One more inverse iteration: components along large eigenvalues weigh more in A's residual than
  // in that of A^-1.
  smallest_vector = factorization_.solve(smallest_vector).normalized();
  result.lambda_max_residual = relative_residual(matrix, largest_vector, result.lambda_max);
  result.lambda_min_residual = relative_residual(matrix, smallest_vector, result.lambda_min);
  return result;
}

ConditionNumber lanczos_condition_number(const LanczosMatrix& matrix) {
  ConditionNumber result{.method = "cg-lanczos"};
  if (matrix.diagonal.empty()) return result;  // b = 0
  const auto [smallest, largest] = extreme_ritz_values(matrix);
  result.lambda_min = smallest.value;
  result.lambda_max = largest.value;
  result.lambda_min_residual = smallest.residual;
  result.lambda_max_residual = largest.residual;
  return result;
}

ConditionNumber better_of(ConditionNumber verified, const ConditionNumber& other) {
  const auto known = [](double value) { return std::isfinite(value) && value > 0.0; };
  if (!(verified.lambda_min_residual <= verified_residual) && known(other.lambda_min) &&
      !(known(verified.lambda_min) && verified.lambda_min <= other.lambda_min)) {
    verified.lambda_min = other.lambda_min;
    verified.lambda_min_residual = other.lambda_min_residual;
  }
  if (!(verified.lambda_max_residual <= verified_residual) && known(other.lambda_max) &&
      !(known(verified.lambda_max) && verified.lambda_max >= other.lambda_max)) {
    verified.lambda_max = other.lambda_max;
    verified.lambda_max_residual = other.lambda_max_residual;
  }
  return verified;
}

ConditionNumber dense_condition_number(const SparseMatrix& matrix,
                                       const std::vector<std::size_t>& column_numbers,
                                       std::size_t n_rows_of_all, const Ranks& ranks) {
  const auto n = static_cast<Eigen::Index>(n_rows_of_all);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (SparseMatrix::InnerIterator entry(matrix, i); entry; ++entry)
      dense(static_cast<Eigen::Index>(column_numbers[static_cast<std::size_t>(i)]),
            static_cast<Eigen::Index>(column_numbers[static_cast<std::size_t>(entry.col())])) =
          entry.value();
  ranks.sum({dense.data(), static_cast<std::size_t>(dense.size())});
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense);
  const auto residual = [&](Eigen::Index k) {
    const double lambda = solver.eigenvalues()[k];
    const Eigen::VectorXd v = solver.eigenvectors().col(k);
    return (dense * v - lambda * v).norm() / lambda;
  };
  return {solver.eigenvalues()[0], solver.eigenvalues()[n - 1], residual(0), residual(n - 1),
          "dense"};
}

ConditionNumber IterativeConditionNumber::compute(const TrilinosMatrix& matrix) {
  constexpr double tolerance = 0.5 * verified_residual;
  const Eigenpair largest = matrix.largest_eigenpair(largest_, tolerance);
  const Eigenpair smallest = matrix.smallest_eigenpair(smallest_, tolerance);
  largest_ = largest.vector;
  smallest_ = smallest.vector;
  return {smallest.value, largest.value, smallest.residual, largest.residual,
          "krylov-schur+lobpcg"};
}

std::vector<double> IterativeConditionNumber::eigenvectors() const {
  if (smallest_.size() == 0 || largest_.size() == 0) return {};
  std::vector<double> both(smallest_.begin(), smallest_.end());
  both.insert(both.end(), largest_.begin(), largest_.end());
  return both;
}

void IterativeConditionNumber::set_eigenvectors(const std::vector<double>& eigenvectors) {
  const auto n = static_cast<Eigen::Index>(eigenvectors.size() / 2);
  smallest_ = Eigen::Map<const Eigen::VectorXd>(eigenvectors.data(), n);
  largest_ = Eigen::Map<const Eigen::VectorXd>(eigenvectors.data() + n, n);
}

}  // namespace smoothfem
