// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "fem/space/finite_element_space.h"

namespace smoothfem {

/// An eigenvalue with a vector that verifies it.
struct Eigenpair {
  double value = 0.0;
  double residual = 1.0;   ///< |A x - value x| / (value |x|), recomputed from the vector
  Eigen::VectorXd vector;  ///< this rank's entries
};

/// Trilinos' copies of matrices that share one pattern, for algebraic multigrid (smoothed
/// aggregation, ML) and eigenvalues (Anasazi). All functions are collective.
class TrilinosMatrix {
 public:
  template <int dim>
  explicit TrilinosMatrix(const FiniteElementSpace<dim>& space);
  ~TrilinosMatrix();
  TrilinosMatrix(const TrilinosMatrix&) = delete;

  /// Takes the values of a matrix with the space's pattern.
  void set_values(const SparseMatrix& matrix);

  /// Rebuilds the hierarchy of grids; it depends on the present values alone.
  void set_up_multigrid();
  /// Computes z = M^-1 r by one V-cycle; r, z: this rank's entries.
  void apply_multigrid(const Eigen::VectorXd& r, Eigen::VectorXd& z) const;

  /// Return an eigenpair by LOBPCG with multigrid as preconditioner (set it up before), or by the
  /// Krylov-Schur method. start: a guess of the eigenvector, or empty. The result's residual
  /// measures its quality; it is above the tolerance if the iteration did not converge.
  Eigenpair smallest_eigenpair(const Eigen::VectorXd& start, double tolerance) const;
  Eigenpair largest_eigenpair(const Eigen::VectorXd& start, double tolerance) const;

 private:
  struct Trilinos;
  std::unique_ptr<Trilinos> trilinos_;
};

}  // namespace smoothfem
