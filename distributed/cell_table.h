// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "distributed/node_directory.h"
#include "smoothing/mesh/compressed_rows.h"

namespace smoothfem {

/// Cells by their numbers in the whole mesh, and the numbers of their corners there.
struct CellTable {
  std::vector<GlobalIndex> numbers{};  ///< ascending
  std::vector<RowOffset> offsets{0};   ///< as in CompressedRows
  std::vector<GlobalIndex> corners{};
  std::vector<int> materials{};  ///< equal numbers: cells of the same physical groups

  std::size_t size() const { return numbers.size(); }
  std::span<const GlobalIndex> operator[](std::size_t c) const {
    return {corners.data() + offsets[c], offsets[c + 1] - offsets[c]};
  }
  void reserve(std::size_t n_cells, std::size_t n_corners) {
    numbers.reserve(n_cells);
    materials.reserve(n_cells);
    offsets.reserve(n_cells + 1);
    corners.reserve(n_corners);
  }
  void append(GlobalIndex number, int material, std::span<const GlobalIndex> corners_of_cell) {
    numbers.push_back(number);
    materials.push_back(material);
    corners.insert(corners.end(), corners_of_cell.begin(), corners_of_cell.end());
    require_countable(corners.size());
    offsets.push_back(static_cast<RowOffset>(corners.size()));
  }
};

/// Sorts cells by their numbers, which may be in any order before.
void sort_by_numbers(CellTable& table);

/// Merges cells into a table, in its memory. Both are sorted and have no number in common. Returns
/// for each cell of the result whether it was in `table` before.
std::vector<std::uint8_t> merge_into(CellTable& table, const CellTable& others);

/// Appends a cell to words for another rank: its number, its material, the number of its corners,
/// these.
inline void append_words(const CellTable& table, std::size_t c, std::vector<GlobalIndex>& words) {
  const auto corners = table[c];
  words.insert(words.end(), {table.numbers[c], static_cast<GlobalIndex>(table.materials[c]),
                             static_cast<GlobalIndex>(corners.size())});
  words.insert(words.end(), corners.begin(), corners.end());
}

/// Returns the cells of such words from all ranks, sorted. n_more: how many further words follow
/// for each corner, after the corners.
CellTable sorted_cells(const std::vector<std::vector<GlobalIndex>>& words, std::size_t n_more);

/// A set of numbers, one bit each, that knows how many of them are below another.
class NumberSet {
 public:
  /// Numbers are below n.
  explicit NumberSet(std::size_t n) : words_(n / 64 + 1, 0) {}

  void add(GlobalIndex number) { words_[number / 64] |= std::uint64_t{1} << number % 64; }
  /// Call it when all numbers are there, before the functions below.
  void count() {
    before_.clear();
    size_ = 0;
    for (const std::uint64_t word : words_) {
      before_.push_back(static_cast<std::uint32_t>(size_));
      size_ += static_cast<std::size_t>(std::popcount(word));
    }
  }

  std::size_t size() const { return size_; }
  /// Returns the position of a number of the set among its numbers.
  std::uint32_t position(GlobalIndex number) const {
    const std::uint64_t below = words_[number / 64] & ((std::uint64_t{1} << number % 64) - 1);
    return before_[number / 64] + static_cast<std::uint32_t>(std::popcount(below));
  }
  /// Returns all numbers, ascending.
  std::vector<GlobalIndex> numbers() const {
    std::vector<GlobalIndex> result;
    result.reserve(size_);
    for (std::size_t w = 0; w < words_.size(); ++w)
      for (std::uint64_t word = words_[w]; word != 0; word &= word - 1)
        result.push_back(
            static_cast<GlobalIndex>(64 * w + static_cast<std::size_t>(std::countr_zero(word))));
    return result;
  }

 private:
  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> before_;  ///< numbers before each word
  std::size_t size_ = 0;
};

}  // namespace smoothfem
