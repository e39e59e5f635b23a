#include "fem/condition_number.h"

#include <Spectra/SymEigsSolver.h>

#include <random>

namespace smoothfem {

namespace {

constexpr double residual_tolerance = 1e-6;

/// What Spectra asks of a linear operator.
template <class Apply>
class Operator {
 public:
  using Scalar = double;
  Operator(Eigen::Index size, Apply apply) : size_(size), apply_(std::move(apply)) {}
  Eigen::Index rows() const { return size_; }
  Eigen::Index cols() const { return size_; }
  void perform_op(const double* in, double* out) const {
    Eigen::Map<Eigen::VectorXd>(out, size_) = apply_(Eigen::Map<const Eigen::VectorXd>(in, size_));
  }

 private:
  Eigen::Index size_;
  Apply apply_;
};

/// A start vector that is the same on every machine and has a part in every eigenvector.
Eigen::VectorXd start_vector(Eigen::Index size) {
  std::mt19937_64 random(1);
  Eigen::VectorXd v(size);
  for (auto& entry : v) entry = 0.5 + static_cast<double>(random() >> 11) * 0x1.0p-53;
  return v;
}

/// Eigenvector of the operator's largest eigenvalue by restarted Lanczos; `vector`: start and
/// result. A start that is nearly an eigenvector would stay at its eigenvalue even where that is
/// not the largest, so callers mix in a part of every eigenvector.
template <class Apply>
void largest_eigenvector(Eigen::Index size, const Apply& apply, Eigen::Index subspace,
                         Eigen::VectorXd& vector) {
  constexpr Eigen::Index max_restarts = 1000;
  Operator<Apply> op(size, apply);
  Spectra::SymEigsSolver<Operator<Apply>> solver(op, 1, std::min(subspace, size));
  solver.init(vector.data());
  solver.compute(Spectra::SortRule::LargestAlge, max_restarts, 0.1 * residual_tolerance);
  if (solver.info() == Spectra::CompInfo::Successful) vector = solver.eigenvectors().col(0);
}

double relative_residual(const SparseMatrix& matrix, const Eigen::VectorXd& v, double& eigenvalue) {
  const Eigen::VectorXd product = matrix * v;
  eigenvalue = v.dot(product) / v.squaredNorm();
  return (product - eigenvalue * v).norm() / (v.norm() * eigenvalue);
}

}  // namespace

ConditionNumber ConditionNumberSolver::compute(const SparseMatrix& matrix) {
  const Eigen::Index n = matrix.rows();
  Eigen::VectorXd largest_vector = start_vector(n), smallest_vector = largest_vector;
  ConditionNumber result;
  if (n == 1) {
    result.lambda_min = result.lambda_max = matrix.coeff(0, 0);
    result.verified = true;
    return result;
  }
  // The matrix is symmetric: its rows are its columns.
  const Eigen::Map<const ColumnMatrix> columns(n, n, matrix.nonZeros(), matrix.outerIndexPtr(),
                                               matrix.innerIndexPtr(), matrix.valuePtr());
  if (!analyzed_) factorization_.analyzePattern(columns);
  analyzed_ = true;
  factorization_.factorize(columns);
  if (factorization_.info() != Eigen::Success) return result;  // not positive definite

  largest_eigenvector(
      n, [&](const auto& v) -> Eigen::VectorXd { return matrix * v; }, 24, largest_vector);
  largest_eigenvector(
      n, [&](const auto& v) -> Eigen::VectorXd { return factorization_.solve(v); }, 12,
      smallest_vector);
  // One more inverse iteration: parts along large eigenvalues weigh more in A's residual than in
  // that of A^-1.
  smallest_vector = factorization_.solve(smallest_vector).normalized();
  result.lambda_max_residual = relative_residual(matrix, largest_vector, result.lambda_max);
  result.lambda_min_residual = relative_residual(matrix, smallest_vector, result.lambda_min);
  result.verified =
      std::max(result.lambda_max_residual, result.lambda_min_residual) < residual_tolerance;
  return result;
}

}  // namespace smoothfem
