#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <vector>

#include "smoothing/mesh/compressed_rows.h"
#include "smoothing/mesh/lanes.h"

namespace smoothfem {

/// A vector of the plane for each row of a block matrix, padded (make_vector) so that it can be
/// read two at a time; what lies behind the rows stays zero.
using BlockVector = std::vector<Point<2>>;

/// Two neighbouring entries of a block vector at once: (x0, y0, x1, y1). Not aligned to 32 bytes.
SMOOTHFEM_INLINE Lanes load_pair(const Point<2>* entries) {
  static_assert(2 * sizeof(Point<2>) == sizeof(Lanes));
  return load_lanes(entries->data());
}
SMOOTHFEM_INLINE void store_pair(Lanes lanes, Point<2>* entries) {
  store_lanes(lanes, entries->data());
}
/// (x, x, y, y) of one entry.
SMOOTHFEM_INLINE Lanes load_each_twice(const Point<2>* entry) {
  using Pair = double __attribute__((vector_size(2 * sizeof(double))));
  Pair pair;
  std::memcpy(&pair, entry, sizeof(pair));
  return __builtin_shufflevector(pair, pair, 0, 0, 1, 1);
}
SMOOTHFEM_INLINE double sum_of(Lanes lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

/// A square sparse matrix of 2 x 2 blocks, one for each pair of nodes, on a fixed pattern (block
/// CSR). One more block behind the last and one more entry of its vectors take what belongs to
/// fixed nodes, so that scattering into them needs no branches.
class BlockMatrix {
 public:
  /// Entries (0,0), (1,0), (0,1), (1,1).
  struct Block {
    double entries[n_lanes];

    SMOOTHFEM_INLINE Lanes load() const { return load_lanes(entries); }
    SMOOTHFEM_INLINE void add(Lanes other) { store_lanes(load() + other, entries); }
  };

  /// pattern: the block columns of each row, sorted ascending, the diagonal among them.
  void set_pattern(CompressedRows<std::uint32_t> pattern) {
    pattern_ = std::move(pattern);
    blocks_.assign(pattern_.n_entries() + 1, Block{});
    diagonal_.clear();
    for (std::uint32_t row = 0; row < n_rows(); ++row) diagonal_.push_back(position(row, row));
  }
  std::size_t n_rows() const { return pattern_.size(); }
  /// A zero vector for this matrix: one entry a row, one unused, and one more if that is odd.
  BlockVector make_vector() const {
    return BlockVector((n_rows() + 2) / 2 * 2, Point<2>(0.0, 0.0));
  }

  /// Where a block is stored; it must be in the pattern.
  std::uint32_t position(std::uint32_t row, std::uint32_t column) const {
    const auto columns = pattern_[row];
    const auto found = std::lower_bound(columns.begin(), columns.end(), column);
    assert(found != columns.end() && *found == column);
    return static_cast<std::uint32_t>(pattern_.offset(row) + (found - columns.begin()));
  }
  /// Position of the block that belongs to no row.
  std::uint32_t unused_position() const { return static_cast<std::uint32_t>(pattern_.n_entries()); }

  Block* blocks() { return blocks_.data(); }
  const Block& block(std::uint32_t position) const { return blocks_[position]; }
  const Block& diagonal_block(std::size_t row) const { return blocks_[diagonal_[row]]; }
  void set_zero() { std::fill(blocks_.begin(), blocks_.end(), Block{}); }

  /// y = A x, rows in order; returns x' y.
  SMOOTHFEM_INLINE double multiply(const BlockVector& x, BlockVector& y) const {
    const Block* block = blocks_.data();
    double product = 0.0;
    for (std::size_t row = 0; row < n_rows(); ++row) {
      Lanes sum{};
      for (const std::uint32_t column : pattern_[row]) {
        sum += (block++)->load() * load_each_twice(&x[column]);
      }
      y[row] = {sum[0] + sum[2], sum[1] + sum[3]};
      product += x[row].x() * y[row].x() + x[row].y() * y[row].y();
    }
    return product;
  }

 private:
  CompressedRows<std::uint32_t> pattern_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> diagonal_;
};

}  // namespace smoothfem
