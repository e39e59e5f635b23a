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

/// Returns a row of A x.
template <int dim, class Number>
inline Point<dim> multiplied_row(const CompressedRows<std::uint32_t>& columns, const Number* blocks,
                                 const BlockVector<dim>& x, std::size_t row) {
  const Number* block = blocks + dim * dim * columns.offset(row);
  Lanes sum{};
  for (const std::uint32_t column : columns[row]) {
    add_product(block, x[column], sum);
    block += dim * dim;
  }
  return total(sum, blocks);
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
  return std::sqrt(matrix_->rows().sum([&](std::size_t i, double& sum) {
    sum += (matrix_->inverse_factor(i) * residual[i]).squaredNorm();
  }));
}

template <int dim>
void BlockConjugateGradients<dim>::precondition(const BlockVector<dim>& residual,
                                                BlockVector<dim>& result) const {
  matrix_->rows().for_each([&](std::size_t i) {
    result[i] = matrix_->inverse_factor(i).transpose() * (matrix_->inverse_factor(i) * residual[i]);
  });
  matrix_->rows().update(result);
}

template <int dim>
double BlockConjugateGradients<dim>::multiply_scaled(const BlockVector<dim>& x,
                                                     BlockVector<dim>& y) const {
  const auto* const blocks = matrix_->scaled_block(0);
  return matrix_->rows().sum([&](std::size_t row, double& sum) {
    y[row] = multiplied_row<dim>(matrix_->columns(), blocks, x, row);
    for (int d = 0; d < dim; ++d) sum += x[row][d] * y[row][d];
  });
}

template <int dim>
typename BlockConjugateGradients<dim>::Result BlockConjugateGradients<dim>::solve(
    const BlockVector<dim>& right, double relative_tolerance, int max_iterations,
    BlockVector<dim>& result) {
  const UnknownRows& rows = matrix_->rows();
  double rho = rows.sum([&](std::size_t i, double& sum) {
    result[i].setZero();
    residual_[i] = direction_[i] = matrix_->inverse_factor(i) * right[i];
    sum += residual_[i].squaredNorm();
  });
  const double goal = relative_tolerance * relative_tolerance * rho;
  Result report;
  for (; report.n_iterations < max_iterations && rho > goal; ++report.n_iterations) {
    rows.update(direction_);
    const double curvature = multiply_scaled(direction_, product_);
    if (!(curvature > 0.0)) {
      if (report.n_iterations == 0) result = direction_;
      report.negative_curvature = true;
      break;
    }
    const double alpha = rho / curvature;
    const double rho_new = rows.sum([&](std::size_t i, double& sum) {
      result[i] += alpha * direction_[i];
      residual_[i] -= alpha * product_[i];
      sum += residual_[i].squaredNorm();
    });
    const double beta = rho_new / rho;
    rho = rho_new;
    rows.for_each([&](std::size_t i) { direction_[i] = residual_[i] + beta * direction_[i]; });
  }
  rows.for_each([&](std::size_t i) {
    result[i] = (matrix_->inverse_factor(i).transpose() * result[i]).eval();
  });
  rows.update(result);
  return report;
}

template class BlockConjugateGradients<2>;
template class BlockConjugateGradients<3>;

}  // namespace smoothfem
