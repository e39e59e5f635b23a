// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear_algebra/sliced_matrix.h"

#include <algorithm>
#include <numeric>

#include "smoothing/simd/lanes.h"

namespace smoothfem {

namespace {

/// Returns the rows in their order, but sorted by length within windows. Slices then have similar
/// lengths and still keep neighbours together.
std::vector<std::uint32_t> rows_by_length(const SparseMatrix& matrix) {
  constexpr std::size_t window = 256;
  const int* starts = matrix.outerIndexPtr();
  std::vector<std::uint32_t> rows(static_cast<std::size_t>(matrix.rows()));
  std::iota(rows.begin(), rows.end(), 0U);
  for (std::size_t first = 0; first < rows.size(); first += window)
    std::stable_sort(
        rows.begin() + static_cast<std::ptrdiff_t>(first),
        rows.begin() + static_cast<std::ptrdiff_t>(std::min(first + window, rows.size())),
        [&](std::uint32_t a, std::uint32_t b) {
          return starts[a + 1] - starts[a] > starts[b + 1] - starts[b];
        });
  while (!rows.empty() && rows.size() % n_lanes != 0) rows.push_back(rows.back());
  return rows;
}

}  // namespace

SlicedMatrix::SlicedMatrix(const SparseMatrix& matrix, const Ranks& ranks, const Halo& halo)
    : ranks_(ranks),
      halo_(halo),
      n_rows_(matrix.rows()),
      n_columns_(matrix.cols()),
      rows_(rows_by_length(matrix)),
      offsets_{0} {
  const int* starts = matrix.outerIndexPtr();
  const int* columns = matrix.innerIndexPtr();
  offsets_.reserve(rows_.size() / n_lanes + 1);
  columns_.reserve(static_cast<std::size_t>(matrix.nonZeros()));
  for (std::size_t slice = 0; slice < rows_.size(); slice += n_lanes) {
    int longest = 0;
    for (std::size_t l = 0; l < n_lanes; ++l)
      longest = std::max(longest, starts[rows_[slice + l] + 1] - starts[rows_[slice + l]]);
    for (int k = 0; k < longest; ++k)
      for (std::size_t l = 0; l < n_lanes; ++l) {
        const int entry = starts[rows_[slice + l]] + k;
        const bool inside = entry < starts[rows_[slice + l] + 1];
        columns_.push_back(inside ? static_cast<std::uint32_t>(columns[entry]) : 0);
      }
    offsets_.push_back(columns_.size());
  }
  values_.resize(columns_.size());
  set_values(matrix);
}

void SlicedMatrix::set_values(const SparseMatrix& matrix) {
  const int* starts = matrix.outerIndexPtr();
  const double* values = matrix.valuePtr();
  for (std::size_t slice = 0; slice + 1 < offsets_.size(); ++slice)
    for (std::size_t l = 0; l < n_lanes; ++l) {
      const int first = starts[rows_[slice * n_lanes + l]],
                size = starts[rows_[slice * n_lanes + l] + 1] - first;
      for (std::size_t p = offsets_[slice] + l, k = 0; p < offsets_[slice + 1]; p += n_lanes, ++k)
        values_[p] = static_cast<int>(k) < size ? values[static_cast<std::size_t>(first) + k] : 0.0;
    }
  diagonal_ = matrix.diagonal();
}

double SlicedMatrix::multiply(Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  halo_.update(x);
  return multiply_rows(x.data(), y.data());
}

double SlicedMatrix::multiply_rows(const double* x, double* y) const {
  Lanes product{};
  std::size_t n_left = static_cast<std::size_t>(n_rows_);  // the last slice may repeat its last row
  for (std::size_t slice = 0; slice + 1 < offsets_.size(); ++slice) {
    Lanes sum{};
    for (std::size_t p = offsets_[slice]; p < offsets_[slice + 1]; p += n_lanes) {
      const std::uint32_t* c = &columns_[p];
      sum += load_lanes(&values_[p]) * Lanes{x[c[0]], x[c[1]], x[c[2]], x[c[3]]};
    }
    const std::uint32_t* rows = &rows_[slice * n_lanes];
    const std::size_t n_here = std::min(n_left, n_lanes);
    for (std::size_t l = 0; l < n_here; ++l) {
      y[rows[l]] = sum[l];
      product[l] += sum[l] * x[rows[l]];
    }
    n_left -= n_here;
  }
  return (product[0] + product[1]) + (product[2] + product[3]);
}

}  // namespace smoothfem
