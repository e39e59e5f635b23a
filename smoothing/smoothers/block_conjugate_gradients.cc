#include "smoothing/smoothers/block_conjugate_gradients.h"

#include <cmath>

namespace smoothfem {

namespace {

/// Two blocks of the preconditioner times two entries.
SMOOTHFEM_INLINE Lanes multiply_pair(const Point<2>* diagonal, const Point<2>* side, Lanes r) {
  const Lanes swapped = __builtin_shufflevector(r, r, 1, 0, 3, 2);
  return load_pair(diagonal) * r + load_pair(side) * swapped;
}

}  // namespace

void BlockConjugateGradients::prepare(const BlockMatrix& matrix) {
  // A block of elements that have almost collapsed is singular to rounding.
  constexpr double relative_shift = 1e-14;
  inverse_diagonal_ = inverse_side_ = matrix.make_vector();
  residual_ = preconditioned_ = direction_ = product_ = inverse_diagonal_;
  for (std::size_t row = 0; row < matrix.n_rows(); ++row) {
    const auto& block = matrix.diagonal_block(row).entries;
    const double shift = relative_shift * (block[0] + block[3]);
    const double a = block[0] + shift, b = block[3] + shift, c = block[1];
    const double scale = 1.0 / (a * b - c * c);
    inverse_diagonal_[row] = {scale * b, scale * a};
    inverse_side_[row] = {-scale * c, -scale * c};
  }
}

double BlockConjugateGradients::norm(const BlockVector& residual) {
  precondition(residual, preconditioned_);
  double sum = 0.0;
  for (std::size_t i = 0; i < residual.size(); ++i) sum += residual[i].dot(preconditioned_[i]);
  return std::sqrt(sum);
}

void BlockConjugateGradients::precondition(const BlockVector& residual, BlockVector& result) const {
  for (std::size_t i = 0; i < residual.size(); i += 2)
    store_pair(multiply_pair(&inverse_diagonal_[i], &inverse_side_[i], load_pair(&residual[i])),
               &result[i]);
}

SMOOTHFEM_VECTOR_CLONES
BlockConjugateGradients::Result BlockConjugateGradients::solve(const BlockMatrix& matrix,
                                                               const BlockVector& right,
                                                               double relative_tolerance,
                                                               int max_iterations,
                                                               BlockVector& result) {
  std::fill(result.begin(), result.end(), Point<2>(0.0, 0.0));
  residual_ = right;
  double rho = norm(residual_);
  rho *= rho;
  direction_ = preconditioned_;
  const double goal = relative_tolerance * relative_tolerance * rho;
  Result report;
  for (; report.n_iterations < max_iterations && rho > goal; ++report.n_iterations) {
    const double curvature = matrix.multiply(direction_, product_);
    if (!(curvature > 0.0)) {
      if (report.n_iterations == 0) result = direction_;
      report.negative_curvature = true;
      break;
    }
    const double alpha = rho / curvature;
    Lanes rho_sums{};
    for (std::size_t i = 0; i < residual_.size(); i += 2) {
      store_pair(load_pair(&result[i]) + alpha * load_pair(&direction_[i]), &result[i]);
      const Lanes r = load_pair(&residual_[i]) - alpha * load_pair(&product_[i]);
      const Lanes z = multiply_pair(&inverse_diagonal_[i], &inverse_side_[i], r);
      store_pair(r, &residual_[i]);
      store_pair(z, &preconditioned_[i]);
      rho_sums += r * z;
    }
    const double rho_new = sum_of(rho_sums), beta = rho_new / rho;
    rho = rho_new;
    for (std::size_t i = 0; i < residual_.size(); i += 2)
      store_pair(load_pair(&preconditioned_[i]) + beta * load_pair(&direction_[i]), &direction_[i]);
  }
  return report;
}

}  // namespace smoothfem
