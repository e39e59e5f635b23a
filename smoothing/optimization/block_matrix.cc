// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/optimization/block_matrix.h"

#include <cmath>

#include "smoothing/simd/lanes.h"

namespace smoothfem {

namespace {

/// Returns L^-1 of a block L L', by Cholesky's method.
template <int dim>
Eigen::Matrix<double, dim, dim> inverse_cholesky_factor(Eigen::Matrix<double, dim, dim> block) {
  // A block of elements that have almost collapsed is singular up to rounding.
  constexpr double relative_shift = 1e-14;
  const double size = block.trace(), shift = relative_shift * size;
  Eigen::Matrix<double, dim, dim> factor = Eigen::Matrix<double, dim, dim>::Zero(),
                                  inverse = factor;
  for (int j = 0; j < dim; ++j) {
    double pivot = block(j, j) + shift;
    for (int k = 0; k < j; ++k) pivot -= factor(j, k) * factor(j, k);
    factor(j, j) = std::sqrt(std::max(pivot, shift));
    for (int i = j + 1; i < dim; ++i) {
      double sum = block(i, j);
      for (int k = 0; k < j; ++k) sum -= factor(i, k) * factor(j, k);
      factor(i, j) = sum / factor(j, j);
    }
  }
  for (int j = 0; j < dim; ++j)
    for (int i = j; i < dim; ++i) {
      double sum = i == j ? 1.0 : 0.0;
      for (int k = j; k < i; ++k) sum -= factor(i, k) * inverse(k, j);
      inverse(i, j) = sum / factor(i, i);
    }
  return inverse;
}

}  // namespace

template <int dim>
BlockMatrix<dim>::BlockMatrix(CompressedRows<std::uint32_t> columns, UnknownRows rows)
    : columns_(std::move(columns)),
      rows_(std::move(rows)),
      inverse_factors_(n_rows() + 1, Block::Zero()),
      scaled_(dim * dim * columns_.n_entries() + n_lanes) {}  // read n_lanes numbers at a time

template <int dim>
std::vector<typename BlockMatrix<dim>::Block> BlockMatrix<dim>::start_diagonal() {
  auto diagonal = std::move(inverse_factors_);
  parallel_for_ranges(diagonal.size(), 16384, [&](std::size_t first, std::size_t last) {
    std::fill(diagonal.begin() + first, diagonal.begin() + last, Block::Zero());
  });
  return diagonal;
}

template <int dim>
void BlockMatrix<dim>::factor_diagonal(std::vector<Block> diagonal) {
  rows_.for_each([&](std::size_t row) {
    std::fill(scaled_block(columns_.offset(row)), scaled_block(columns_.offset(row + 1)),
              Number{0});
    const Block factor = inverse_cholesky_factor<dim>(diagonal[row]);
    const Block scaled = factor * diagonal[row] * factor.transpose();
    const auto number = static_cast<std::uint32_t>(row);
    std::copy(scaled.data(), scaled.data() + dim * dim, scaled_block(position(number, number)));
    diagonal[row] = factor;
  });
  rows_.update(diagonal);
  inverse_factors_ = std::move(diagonal);
}

template class BlockMatrix<2>;
template class BlockMatrix<3>;

}  // namespace smoothfem
