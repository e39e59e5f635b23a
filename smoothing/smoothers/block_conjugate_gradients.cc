#include "smoothing/smoothers/block_conjugate_gradients.h"

#include <cmath>

#include "smoothing/mesh/lanes.h"

namespace smoothfem {

namespace {

/// L^-1 of a block L L', by Cholesky's method.
template <int dim>
Eigen::Matrix<double, dim, dim> inverse_factor(Eigen::Matrix<double, dim, dim> block) {
  // A block of elements that have almost collapsed is singular to rounding.
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

SMOOTHFEM_INLINE Lanes load_column(const double* numbers) {
  return load_lanes(numbers);
}
SMOOTHFEM_INLINE Lanes load_column(const float* numbers) {
  using Floats = float __attribute__((vector_size(n_lanes * sizeof(float))));
  using Unaligned = float
      __attribute__((vector_size(n_lanes * sizeof(float)), aligned(sizeof(float)), may_alias));
  const Floats floats = *reinterpret_cast<const Unaligned*>(numbers);
  return __builtin_convertvector(floats, Lanes);
}

/// Adds a block times an entry to `sum`: in the plane its two halves are to be added up in the end,
/// in space its last number means nothing.
SMOOTHFEM_INLINE void add_product(const double* block, const Point<2>& x, Lanes& sum) {
  sum += load_column(block) * Lanes{x[0], x[0], x[1], x[1]};
}
SMOOTHFEM_INLINE void add_product(const float* block, const Point<3>& x, Lanes& sum) {
  sum += load_column(block) * x[0];
  sum += load_column(block + 3) * x[1];
  sum += load_column(block + 6) * x[2];
}
SMOOTHFEM_INLINE Point<2> total(Lanes sum, const double*) {
  return {sum[0] + sum[2], sum[1] + sum[3]};
}
SMOOTHFEM_INLINE Point<3> total(Lanes sum, const float*) {
  return {sum[0], sum[1], sum[2]};
}

/// Rows first .. last-1 of y = A x; returns their part of x' y.
template <int dim, class Number>
SMOOTHFEM_INLINE double multiply_range(const CompressedRows<std::uint32_t>& columns,
                                       const Number* blocks, const BlockVector<dim>& x,
                                       BlockVector<dim>& y, std::size_t first, std::size_t last) {
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
// Templates cannot be compiled for several kinds of registers; these can.
SMOOTHFEM_VECTOR_CLONES
double multiply_rows(const CompressedRows<std::uint32_t>& columns, const double* blocks,
                     const BlockVector<2>& x, BlockVector<2>& y, std::size_t first,
                     std::size_t last) {
  return multiply_range<2>(columns, blocks, x, y, first, last);
}
SMOOTHFEM_VECTOR_CLONES
double multiply_rows(const CompressedRows<std::uint32_t>& columns, const float* blocks,
                     const BlockVector<3>& x, BlockVector<3>& y, std::size_t first,
                     std::size_t last) {
  return multiply_range<3>(columns, blocks, x, y, first, last);
}

}  // namespace

template <int dim>
void BlockConjugateGradients<dim>::prepare(const BlockMatrix<dim>& matrix) {
  columns_ = &matrix.columns();
  const std::size_t n = matrix.n_rows();
  inverse_factors_.resize(n);
  for_row_ranges(n, [&](std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row)
      inverse_factors_[row] = inverse_factor<dim>(matrix.diagonal_block(row));
  });
  scaled_.resize(dim * dim * columns_->n_entries() +
                 n_lanes);  // columns are read n_lanes at a time
  for_row_ranges(n, [&](std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row)
      for (std::size_t k = columns_->offset(row); k < columns_->offset(row + 1); ++k) {
        const auto column = columns_->entries()[k];
        const Block scaled = inverse_factors_[row] *
                             matrix.entry(static_cast<std::uint32_t>(row), k) *
                             inverse_factors_[column].transpose();
        for (int i = 0; i < dim * dim; ++i)
          scaled_[dim * dim * k + i] = static_cast<Number>(scaled.data()[i]);
      }
  });
  residual_.resize(n);
  direction_.resize(n);
  product_.resize(n);
}

template <int dim>
double BlockConjugateGradients<dim>::norm(const BlockVector<dim>& residual) const {
  return std::sqrt(sum_over_ranges(residual.size(), [&](std::size_t first, std::size_t last) {
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i)
      sum += (inverse_factors_[i] * residual[i]).squaredNorm();
    return sum;
  }));
}

template <int dim>
void BlockConjugateGradients<dim>::precondition(const BlockVector<dim>& residual,
                                                BlockVector<dim>& result) const {
  for_row_ranges(residual.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      result[i] = inverse_factors_[i].transpose() * (inverse_factors_[i] * residual[i]);
  });
}

template <int dim>
double BlockConjugateGradients<dim>::multiply_scaled(const BlockVector<dim>& x,
                                                     BlockVector<dim>& y) const {
  return sum_over_ranges(x.size(), [&](std::size_t first, std::size_t last) {
    return multiply_rows(*columns_, scaled_.data(), x, y, first, last);
  });
}

template <int dim>
std::size_t BlockConjugateGradients<dim>::bytes_of_multiplication() const {
  return columns_->n_entries() * (dim * dim * sizeof(Number) + sizeof(std::uint32_t)) +
         columns_->size() * (2 * sizeof(Point<dim>) + sizeof(std::size_t));
}

template <int dim>
typename BlockConjugateGradients<dim>::Result BlockConjugateGradients<dim>::solve(
    const BlockVector<dim>& right, double relative_tolerance, int max_iterations,
    BlockVector<dim>& result) {
  const std::size_t n = right.size();
  const auto scale_back = [&](BlockVector<dim>& scaled) {
    for_row_ranges(n, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        scaled[i] = (inverse_factors_[i].transpose() * scaled[i]).eval();
    });
  };
  double rho = sum_over_ranges(n, [&](std::size_t first, std::size_t last) {
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i) {
      result[i].setZero();
      residual_[i] = direction_[i] = inverse_factors_[i] * right[i];
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
