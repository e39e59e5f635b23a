// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <string>
#include <vector>

#include "fem/linear_algebra/conjugate_gradients.h"
#include "fem/linear_algebra/trilinos_matrix.h"
#include "fem/space/finite_element_space.h"

namespace smoothfem {

/// Condition number of a symmetric positive definite matrix in the 2-norm, with its eigenvalues.
struct ConditionNumber {
  double lambda_min = 0.0;
  double lambda_max = 0.0;
  /// |A x - lambda x| / lambda of the pairs. The eigenvalue's relative error is at most this and,
  /// with a gap to the next eigenvalue, about its square.
  double lambda_min_residual = 1.0;
  double lambda_max_residual = 1.0;
  std::string method;  ///< name in results

  double value() const { return lambda_max / lambda_min; }
  double residual() const { return std::max(lambda_min_residual, lambda_max_residual); }
};

/// Largest value of both residuals of a verified condition number.
constexpr double verified_residual = 1e-6;

/// Returns the condition number from the extreme Ritz values of a CG run without preconditioner.
/// They lie inside the spectrum, so that the result is low, usually by less than 1e-3 once CG has
/// converged to 1e-8. The residuals are those of the Ritz vectors of an exact Lanczos process.
ConditionNumber lanczos_condition_number(const LanczosMatrix& matrix);

/// Replaces an unverified pair by the better of its value and that of `other`: both lie inside the
/// spectrum.
ConditionNumber better_of(ConditionNumber verified, const ConditionNumber& other);

/// Computes all eigenvalues at once, for matrices of up to dense_limit rows. column_numbers: see
/// FiniteElementSpace. Collective.
ConditionNumber dense_condition_number(const SparseMatrix& matrix,
                                       const std::vector<std::size_t>& column_numbers,
                                       std::size_t n_rows_of_all, const Ranks& ranks);
constexpr std::size_t dense_limit = 100;

/// Condition numbers for planar meshes on one process. The largest eigenvalue comes from the
/// Lanczos method on A, the smallest from the Lanczos method on A^-1. A sparse Cholesky
/// factorization solves with A; its symbolic part is done once for all matrices of a pattern. In
/// space the factors get too large.
class CholeskyConditionNumber {
 public:
  /// Returns the condition number; residuals are recomputed from the vectors. All zero if the
  /// matrix is not positive definite.
  ConditionNumber compute(const SparseMatrix& matrix);

 private:
  using ColumnMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

  Eigen::SimplicialLLT<ColumnMatrix> factorization_;
  bool analyzed_ = false;
};

/// Condition numbers for volume meshes. The largest eigenvalue comes from the Krylov-Schur method,
/// the smallest from LOBPCG with algebraic multigrid; each starts from the previous vector.
/// Residuals are recomputed from the vectors.
class IterativeConditionNumber {
 public:
  /// matrix: with its values set and multigrid set up. Collective.
  ConditionNumber compute(const TrilinosMatrix& matrix);

  /// Returns this rank's entries of the last vectors, the smallest eigenvalue's first; empty if
  /// there are none.
  std::vector<double> eigenvectors() const;
  void set_eigenvectors(const std::vector<double>& eigenvectors);

 private:
  Eigen::VectorXd smallest_, largest_;
};

}  // namespace smoothfem
