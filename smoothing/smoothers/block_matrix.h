#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

#include "smoothing/mesh/compressed_rows.h"
#include "smoothing/mesh/mesh.h"
#include "smoothing/mesh/parallel.h"

namespace smoothfem {

/// A vector with an entry for each row of a block matrix.
template <int dim>
using BlockVector = std::vector<Point<dim>>;

/// Rows that one thread takes at a time: what fixes the order of sums over them.
inline constexpr std::size_t row_grain = 1024;

/// Calls work(first, last) for ranges of rows, by several threads where there are enough rows: with
/// fewer, waiting for each other at the end of every loop costs more than it gains.
template <class Work>
void for_row_ranges(std::size_t n_rows, const Work& work) {
  constexpr std::size_t min_rows = 16384;
  if (n_rows >= min_rows) return parallel_for_ranges(n_rows, row_grain, work);
  for (std::size_t first = 0; first < n_rows; first += row_grain)
    work(first, std::min(first + row_grain, n_rows));
}

/// Sum of part(first, last) over ranges of rows, the same for every number of threads.
template <class Part>
double sum_over_ranges(std::size_t n_rows, const Part& part) {
  std::vector<double> parts((n_rows + row_grain - 1) / row_grain);
  for_row_ranges(n_rows, [&](std::size_t first, std::size_t last) {
    parts[first / row_grain] = part(first, last);
  });
  double sum = 0.0;
  for (const double value : parts) sum += value;
  return sum;
}

template <int dim>
double dot(const BlockVector<dim>& a, const BlockVector<dim>& b) {
  return sum_over_ranges(a.size(), [&](std::size_t first, std::size_t last) {
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i) sum += a[i].dot(b[i]);
    return sum;
  });
}

/// A symmetric sparse matrix of dim x dim blocks, one for each pair of nodes, on a fixed pattern.
/// Only the diagonal blocks and those right of them are stored, row by row.
template <int dim>
class BlockMatrix {
 public:
  using Block = Eigen::Matrix<double, dim, dim>;  ///< columns first

  BlockMatrix() = default;
  /// columns: those of each row, sorted ascending, the diagonal among them; a symmetric pattern.
  explicit BlockMatrix(CompressedRows<std::uint32_t> columns) : columns_(std::move(columns)) {
    std::uint32_t n_stored = 0;
    for (std::uint32_t row = 0; row < n_rows(); ++row) {
      diagonal_.push_back(n_stored);
      for (const std::uint32_t column : columns_[row]) n_stored += column >= row;
    }
    blocks_.resize(n_stored);
    // Row after row meets the blocks of the rows above it in their order.
    std::vector<std::uint32_t> next;
    for (std::uint32_t row = 0; row < n_rows(); ++row) {
      std::uint32_t own = diagonal_[row];
      for (const std::uint32_t column : columns_[row])
        positions_.push_back(column < row ? next[column]++ : own++);
      next.push_back(diagonal_[row] + 1);
    }
  }

  std::size_t n_rows() const { return columns_.size(); }
  BlockVector<dim> make_vector() const { return BlockVector<dim>(n_rows(), Point<dim>::Zero()); }

  /// Where the block of row <= column is stored; it must be in the pattern.
  std::uint32_t position(std::uint32_t row, std::uint32_t column) const {
    const auto all = columns_[row];
    const auto diagonal = std::lower_bound(all.begin(), all.end(), row);
    const auto found = std::lower_bound(diagonal, all.end(), column);
    assert(row <= column && found != all.end() && *found == column);
    return diagonal_[row] + static_cast<std::uint32_t>(found - diagonal);
  }

  Block& block(std::uint32_t position) { return blocks_[position]; }
  const Block& diagonal_block(std::size_t row) const { return blocks_[diagonal_[row]]; }
  void set_zero() {
    for_row_ranges(blocks_.size(), [&](std::size_t first, std::size_t last) {
      std::fill(blocks_.begin() + first, blocks_.begin() + last, Block::Zero());
    });
  }

  const CompressedRows<std::uint32_t>& columns() const { return columns_; }
  /// Block number k of columns().entries(), in the row given.
  Block entry(std::uint32_t row, std::size_t k) const {
    const Block& stored = blocks_[positions_[k]];
    return columns_.entries()[k] < row ? Block(stored.transpose()) : stored;
  }

 private:
  CompressedRows<std::uint32_t> columns_;
  std::vector<std::uint32_t> positions_;  ///< of the block (or its transpose) of each column
  std::vector<std::uint32_t> diagonal_;   ///< position of each row's diagonal block
  std::vector<Block> blocks_;
};

}  // namespace smoothfem
