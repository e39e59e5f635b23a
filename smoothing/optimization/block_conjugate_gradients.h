// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/optimization/block_matrix.h"

namespace smoothfem {

/// Conjugate gradients for A x = b, preconditioned by the inverses of A's diagonal blocks L L',
/// which must be positive definite. A itself may be indefinite, which is detected. In a part of a
/// mesh all functions are collective, and results have the values of owners in copied rows.
template <int dim>
class BlockConjugateGradients {
 public:
  struct Result {
    int n_iterations = 0;
    bool negative_curvature = false;  ///< a direction d with d' A d <= 0 was found
  };

  /// Prepares solves with a filled matrix, which must not change while it is in use here.
  void prepare(const BlockMatrix<dim>& matrix);

  /// Returns the norm of a residual that belongs to the preconditioner.
  double norm(const BlockVector<dim>& residual) const;
  /// Computes z = M^-1 r. If r is a negative gradient, z is a descent direction, also after each
  /// entry is shortened by its own factor.
  void precondition(const BlockVector<dim>& residual, BlockVector<dim>& result) const;

  /// Starts at zero. Ends when the residual's norm is at most relative_tolerance times that of
  /// `right`, after max_iterations, or at the first direction of no positive curvature. `result` is
  /// then the iterate before that direction, or the preconditioned right-hand side if there is
  /// none.
  Result solve(const BlockVector<dim>& right, double relative_tolerance, int max_iterations,
               BlockVector<dim>& result);

 private:
  /// Computes y = A x with the scaled matrix; returns x' y.
  double multiply_scaled(const BlockVector<dim>& x, BlockVector<dim>& y) const;

  const BlockMatrix<dim>* matrix_ = nullptr;
  BlockVector<dim> residual_, direction_, product_;
};

}  // namespace smoothfem
