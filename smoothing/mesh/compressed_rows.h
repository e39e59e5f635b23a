// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "smoothing/base/input_error.h"

namespace smoothfem {

/// Counts the entries of all rows. Half the length of std::size_t, since large meshes have many
/// short rows.
using RowOffset = std::uint32_t;

/// Throws InputError if there are too many entries for RowOffset.
inline void require_countable(std::size_t n_entries) {
  if (n_entries > std::numeric_limits<RowOffset>::max())
    throw InputError("a table of the mesh would have " + std::to_string(n_entries) +
                     " entries, but at most " +
                     std::to_string(std::numeric_limits<RowOffset>::max()) +
                     " are possible; use a smaller mesh");
}

/// Rows of different lengths in two arrays (CSR): row i is entries[offsets[i]] to
/// entries[offsets[i+1] - 1]. Valid after default construction (no rows).
template <class T>
class CompressedRows {
 public:
  CompressedRows() : offsets_{0} {}

  /// offsets: n_rows + 1 ascending values that start at 0; the last one is entries.size().
  CompressedRows(std::vector<RowOffset> offsets, std::vector<T> entries)
      : offsets_(std::move(offsets)), entries_(std::move(entries)) {
    assert(!offsets_.empty() && offsets_.front() == 0 && offsets_.back() == entries_.size());
  }

  std::size_t size() const { return offsets_.size() - 1; }
  bool empty() const { return size() == 0; }
  std::size_t n_entries() const { return entries_.size(); }

  std::span<const T> operator[](std::size_t row) const {
    assert(row < size());
    return {entries_.data() + offsets_[row], offsets_[row + 1] - offsets_[row]};
  }

  /// Returns the position of a row's first entry in entries().
  std::size_t offset(std::size_t row) const { return offsets_[row]; }
  const std::vector<T>& entries() const { return entries_; }

  /// Appends a row. Throws InputError if there are then too many entries.
  template <class Range>
  void append(const Range& row) {
    entries_.insert(entries_.end(), std::begin(row), std::end(row));
    require_countable(entries_.size());
    offsets_.push_back(static_cast<RowOffset>(entries_.size()));
  }

  bool operator==(const CompressedRows&) const = default;

 private:
  std::vector<RowOffset> offsets_;
  std::vector<T> entries_;
};

/// Returns the offsets of rows whose lengths are lengths[1], lengths[2], ...; lengths[0] is 0.
/// Throws InputError if there are too many entries.
inline std::vector<RowOffset> row_offsets(std::vector<RowOffset> lengths) {
  std::size_t sum = 0;
  for (RowOffset& length : lengths) {
    sum += length;
    require_countable(sum);
    length = static_cast<RowOffset>(sum);
  }
  return lengths;
}

/// Returns for each number below n_numbers the rows that have it as an entry, ascending.
inline CompressedRows<std::uint32_t> rows_by_entry(const CompressedRows<std::uint32_t>& rows,
                                                   std::size_t n_numbers) {
  std::vector<RowOffset> lengths(n_numbers + 1, 0);
  for (const std::uint32_t number : rows.entries()) ++lengths[number + 1];
  auto offsets = row_offsets(std::move(lengths));
  std::vector<std::uint32_t> entries(rows.n_entries());
  auto next = offsets;
  for (std::uint32_t row = 0; row < rows.size(); ++row)
    for (const std::uint32_t number : rows[row]) entries[next[number]++] = row;
  return {std::move(offsets), std::move(entries)};
}

}  // namespace smoothfem
