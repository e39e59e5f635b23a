// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/optimization/block_conjugate_gradients.h"

#include <cmath>

#include "smoothing/simd/lanes.h"

namespace smoothfem {

namespace {

/// Adds a block times an entry to `sum`. In the plane the caller has to add its two halves at the
/// end; in space its last number is meaningless.
inline void add_product(const double* block, const Point<2>& x, Lanes& sum) {
  sum += load_lanes(block) * Lanes{x[0], x[0], x[1], x[1]};
}
inline void add_product(const float* block, const Point<3>& x, Lanes& sum) {
  sum += __builtin_convertvector(load_lanes(block), Lanes) * x[0];
  sum += __builtin_convertvector(load_lanes(block + 3), Lanes) * x[1];
  sum += __builtin_convertvector(load_lanes(block + 6), Lanes) * x[2];
}
inline Point<2> total(Lanes sum, const double*) {
  return {sum[0] + sum[2], sum[1] + sum[3]};
}
inline Point<3> total(Lanes sum, const float*) {
  return {sum[0], sum[1], sum[2]};
}

/// Computes rows first .. last-1 of y = A x; returns their part of x' y.
template <int dim, class Number>
inline double multiply_range(const CompressedRows<std::uint32_t>& columns, const Number* blocks,
                             const BlockVector<dim>& x, BlockVector<dim>& y, std::size_t first,
                             std::size_t last) {
  const Number* block = blocks + dim * dim * columns.offset(first);
  double product = 0.0;
  for (std::size_t row = first; row < last; ++row) {
    Lanes sum{};
    for (const std::uint32_t column : columns[row]) {
      add_product(block, x[column], sum);
      block += dim * dim;
    }
    y[row] = total(sum, blocks);
    for (int d = 0; d < dim; ++d) product += x[row][d] * y[row][d];
  }
  return product;
}
}  // namespace

template <int dim>
void BlockConjugateGradients<dim>::prepare(const BlockMatrix<dim>& matrix) {
  matrix_ = &matrix;
  residual_.resize(matrix.n_rows());
  direction_.resize(matrix.n_rows());
  product_.resize(matrix.n_rows());
}

template <int dim>
double BlockConjugateGradients<dim>::norm(const BlockVector<dim>& residual) const {
  return std::sqrt(sum_over_ranges(residual.size(), [&](std::size_t first, std::size_t last) {
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i)
      sum += (matrix_->inverse_factor(i) * residual[i]).squaredNorm();
    return sum;
  }));
}

template <int dim>
void BlockConjugateGradients<dim>::precondition(const BlockVector<dim>& residual,
                                                BlockVector<dim>& result) const {
  for_row_ranges(residual.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      result[i] =
          matrix_->inverse_factor(i).transpose() * (matrix_->inverse_factor(i) * residual[i]);
  });
}

template <int dim>
double BlockConjugateGradients<dim>::multiply_scaled(const BlockVector<dim>& x,
                                                     BlockVector<dim>& y) const {
  return sum_over_ranges(x.size(), [&](std::size_t first, std::size_t last) {
    return multiply_range<dim>(matrix_->columns(), matrix_->scaled_block(0), x, y, first, last);
  });
}

template <int dim>
typename BlockConjugateGradients<dim>::Result BlockConjugateGradients<dim>::solve(
    const BlockVector<dim>& right, double relative_tolerance, int max_iterations,
    BlockVector<dim>& result) {
  const std::size_t n = right.size();
  const auto scale_back = [&](BlockVector<dim>& scaled) {
    for_row_ranges(n, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        scaled[i] = (matrix_->inverse_factor(i).transpose() * scaled[i]).eval();
    });
  };
  double rho = sum_over_ranges(n, [&](std::size_t first, std::size_t last) {
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i) {
      result[i].setZero();
      residual_[i] = direction_[i] = matrix_->inverse_factor(i) * right[i];
      sum += residual_[i].squaredNorm();
    }
    return sum;
  });
  const double goal = relative_tolerance * relative_tolerance * rho;
  Result report;
  for (; report.n_iterations < max_iterations && rho > goal; ++report.n_iterations) {
    const double curvature = multiply_scaled(direction_, product_);
    if (!(curvature > 0.0)) {
      if (report.n_iterations == 0) result = direction_;
      report.negative_curvature = true;
      break;
    }
    const double alpha = rho / curvature;
    const double rho_new = sum_over_ranges(n, [&](std::size_t first, std::size_t last) {
      double sum = 0.0;
      for (std::size_t i = first; i < last; ++i) {
        result[i] += alpha * direction_[i];
        residual_[i] -= alpha * product_[i];
        sum += residual_[i].squaredNorm();
      }
      return sum;
    });
    const double beta = rho_new / rho;
    rho = rho_new;
    for_row_ranges(n, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        direction_[i] = residual_[i] + beta * direction_[i];
    });
  }
  scale_back(result);
  return report;
}

template class BlockConjugateGradients<2>;
template class BlockConjugateGradients<3>;

}  // namespace smoothfem
