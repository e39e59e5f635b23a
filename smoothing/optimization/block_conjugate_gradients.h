// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/optimization/block_matrix.h"

namespace smoothfem {

/// Conjugate gradients for A x = b, preconditioned by the inverses of A's diagonal blocks L L',
/// which must be positive definite. A itself need not be: that is detected.
template <int dim>
class BlockConjugateGradients {
 public:
  struct Result {
    int n_iterations = 0;
    bool negative_curvature = false;  ///< a direction d with d' A d <= 0 turned up
  };

  /// Takes a filled matrix, which has to stay as it is while it is in use here.
  void prepare(const BlockMatrix<dim>& matrix);

  /// Length of a residual as the preconditioner measures it.
  double norm(const BlockVector<dim>& residual) const;
  /// z = M^-1 r: descends wherever r is a negative gradient, also when each entry is shortened by
  /// a factor of its own.
  void precondition(const BlockVector<dim>& residual, BlockVector<dim>& result) const;

  /// Starts at zero and ends when the residual's norm is no more than relative_tolerance times that
  /// of `right`, after max_iterations, or at the first direction of no positive curvature; `result`
  /// is the iterate before that (the preconditioned right side if there is none).
  Result solve(const BlockVector<dim>& right, double relative_tolerance, int max_iterations,
               BlockVector<dim>& result);

 private:
  /// y = A x with the scaled matrix; returns x' y.
  double multiply_scaled(const BlockVector<dim>& x, BlockVector<dim>& y) const;

  const BlockMatrix<dim>* matrix_ = nullptr;
  BlockVector<dim> residual_, direction_, product_;
};

}  // namespace smoothfem
