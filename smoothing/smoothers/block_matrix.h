#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

#include "smoothing/mesh/compressed_rows.h"

namespace smoothfem {

/// A square sparse matrix of dense size x size blocks on a fixed pattern (block CSR).
template <int size>
class BlockMatrix {
 public:
  using Block = Eigen::Matrix<double, size, size, Eigen::RowMajor>;
  using Vector = std::vector<Eigen::Matrix<double, size, 1>>;
  static constexpr std::uint32_t absent = UINT32_MAX;

  /// pattern: the block columns of each row, sorted ascending, the diagonal among them.
  void set_pattern(CompressedRows<std::uint32_t> pattern) {
    pattern_ = std::move(pattern);
    blocks_.resize(pattern_.n_entries());
  }
  std::size_t n_rows() const { return pattern_.size(); }

  /// Where a block is stored; it must be in the pattern.
  std::uint32_t position(std::uint32_t row, std::uint32_t column) const {
    const auto columns = pattern_[row];
    const auto found = std::lower_bound(columns.begin(), columns.end(), column);
    assert(found != columns.end() && *found == column);
    return static_cast<std::uint32_t>(pattern_.offset(row) + (found - columns.begin()));
  }
  Block& block(std::uint32_t position) { return blocks_[position]; }
  const Block& block(std::uint32_t position) const { return blocks_[position]; }
  void set_zero() { std::fill(blocks_.begin(), blocks_.end(), Block::Zero()); }

  /// y = A x, rows in order.
  void multiply(const Vector& x, Vector& y) const {
    for (std::size_t row = 0; row < n_rows(); ++row) {
      Eigen::Matrix<double, size, 1> sum = Eigen::Matrix<double, size, 1>::Zero();
      std::size_t p = pattern_.offset(row);
      for (const std::uint32_t column : pattern_[row]) sum.noalias() += blocks_[p++] * x[column];
      y[row] = sum;
    }
  }

 private:
  CompressedRows<std::uint32_t> pattern_;
  std::vector<Block> blocks_;
};

}  // namespace smoothfem
