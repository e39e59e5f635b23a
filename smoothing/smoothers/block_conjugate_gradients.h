#pragma once

#include "smoothing/smoothers/block_matrix.h"

namespace smoothfem {

/// Conjugate gradients for A x = b, preconditioned by the inverses of A's diagonal blocks, which
/// must be positive definite. A itself need not be: that is found out.
class BlockConjugateGradients {
 public:
  struct Result {
    int n_iterations = 0;
    bool negative_curvature = false;  ///< a direction d with d' A d <= 0 turned up
  };

  /// Takes the pattern's size and the diagonal blocks.
  void prepare(const BlockMatrix& matrix);

  /// Length of a residual as the preconditioner measures it.
  double norm(const BlockVector& residual);
  /// z = M^-1 r: descends wherever r is a negative gradient, also when each entry is shortened by
  /// a factor of its own.
  void precondition(const BlockVector& residual, BlockVector& result) const;

  /// Starts at zero and ends when the residual's norm is no more than relative_tolerance times that
  /// of `right`, after max_iterations, or at the first direction of no positive curvature; `result`
  /// is the iterate before that (the preconditioned right side if there is none).
  Result solve(const BlockMatrix& matrix, const BlockVector& right, double relative_tolerance,
               int max_iterations, BlockVector& result);

 private:
  /// Two blocks (a, c; c, b) of the inverse at a time: a and b of both, c of both.
  BlockVector inverse_diagonal_, inverse_side_;
  BlockVector residual_, preconditioned_, direction_, product_;
};

}  // namespace smoothfem
