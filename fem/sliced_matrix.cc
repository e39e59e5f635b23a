#include "fem/sliced_matrix.h"

#include <algorithm>
#include <numeric>

#include "smoothing/mesh/lanes.h"

namespace smoothfem {

namespace {

constexpr std::uint32_t padding = UINT32_MAX;

/// Rows in their order, but sorted by length within windows: slices of similar lengths that still
/// keep neighbours together.
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

SlicedMatrix::SlicedMatrix(const SparseMatrix& matrix)
    : size_(matrix.rows()), rows_(rows_by_length(matrix)), offsets_{0} {
  const int* starts = matrix.outerIndexPtr();
  const int* columns = matrix.innerIndexPtr();
  for (std::size_t slice = 0; slice < rows_.size(); slice += n_lanes) {
    int longest = 0;
    for (std::size_t l = 0; l < n_lanes; ++l)
      longest = std::max(longest, starts[rows_[slice + l] + 1] - starts[rows_[slice + l]]);
    for (int k = 0; k < longest; ++k)
      for (std::size_t l = 0; l < n_lanes; ++l) {
        const int place = starts[rows_[slice + l]] + k;
        const bool inside = place < starts[rows_[slice + l] + 1];
        columns_.push_back(inside ? static_cast<std::uint32_t>(columns[place]) : 0);
        places_.push_back(inside ? static_cast<std::uint32_t>(place) : padding);
      }
    offsets_.push_back(columns_.size());
  }
  values_.resize(columns_.size());
  set_values(matrix);
}

void SlicedMatrix::set_values(const SparseMatrix& matrix) {
  const double* values = matrix.valuePtr();
  for (std::size_t p = 0; p < places_.size(); ++p)
    values_[p] = places_[p] == padding ? 0.0 : values[places_[p]];
  diagonal_ = matrix.diagonal();
}

SMOOTHFEM_VECTOR_CLONES
void SlicedMatrix::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  const double* in = x.data();
  double* out = y.data();
  for (std::size_t slice = 0; slice + 1 < offsets_.size(); ++slice) {
    Lanes sum{};
    for (std::size_t p = offsets_[slice]; p < offsets_[slice + 1]; p += n_lanes) {
      const double* v = &values_[p];
      const std::uint32_t* c = &columns_[p];
      sum += Lanes{v[0], v[1], v[2], v[3]} * Lanes{in[c[0]], in[c[1]], in[c[2]], in[c[3]]};
    }
    const std::uint32_t* rows = &rows_[slice * n_lanes];
    for (std::size_t l = 0; l < n_lanes; ++l) out[rows[l]] = sum[l];
  }
}

}  // namespace smoothfem
