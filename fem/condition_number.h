#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <string>
#include <vector>

#include "fem/finite_element_space.h"

namespace smoothfem {

/// Condition number of a symmetric positive definite matrix in the 2-norm, and what it is made of.
struct ConditionNumber {
  double lambda_min = 0.0;
  double lambda_max = 0.0;
  /// |A x - lambda x| / lambda of the pairs, recomputed from the vectors; the eigenvalue's relative
  /// error is at most this and, with a gap to the next one, about its square.
  double lambda_min_residual = 0.0;
  double lambda_max_residual = 0.0;
  bool verified = false;  ///< both residuals are below the tolerance asked for

  double value() const { return lambda_max / lambda_min; }
};

/// Extreme eigenvalues of matrices that share one pattern: the largest by the Lanczos method on A,
/// the smallest by the Lanczos method on A^-1 with a sparse Cholesky factorization, whose symbolic
/// part is done once.
class ConditionNumberSolver {
 public:
  /// Name of the method in results.
  static constexpr const char* method = "lanczos+cholesky";

  ConditionNumber compute(const SparseMatrix& matrix);

 private:
  using ColumnMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

  Eigen::SimplicialLLT<ColumnMatrix> factorization_;
  bool analyzed_ = false;
};

}  // namespace smoothfem
