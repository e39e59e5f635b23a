#pragma once

#include <type_traits>

#include "smoothing/smoothers/block_matrix.h"

namespace smoothfem {

/// Conjugate gradients for A x = b, preconditioned by the inverses of A's diagonal blocks L L',
/// which must be positive definite. A itself need not be: that is found out. It works on a scaled
/// copy of A, L^-1 A L'^-1, which needs no preconditioner and has blocks of one size whatever the
/// size of the elements: in space, where reading the matrix takes most of the time, numbers of half
/// the length are enough for them.
template <int dim>
class BlockConjugateGradients {
 public:
  struct Result {
    int n_iterations = 0;
    bool negative_curvature = false;  ///< a direction d with d' A d <= 0 turned up
  };

  /// Takes a matrix, scaled.
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

  /// y = A x with the scaled matrix; returns x' y. For measuring.
  double multiply_scaled(const BlockVector<dim>& x, BlockVector<dim>& y) const;
  /// What that reads and writes at least.
  std::size_t bytes_of_multiplication() const;

 private:
  using Number = std::conditional_t<dim == 2, double, float>;
  using Block = Eigen::Matrix<double, dim, dim>;

  const CompressedRows<std::uint32_t>* columns_ = nullptr;
  std::vector<Number> scaled_;          ///< dim x dim, columns first, for each entry of columns_
  std::vector<Block> inverse_factors_;  ///< L^-1 of each row
  BlockVector<dim> residual_, direction_, product_;
};

}  // namespace smoothfem
