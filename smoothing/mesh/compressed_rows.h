#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace smoothfem {

/// Rows of different lengths in two arrays (CSR): row i is entries[offsets[i]] ..
/// entries[offsets[i+1]]. Valid after default construction (no rows).
template <class T>
class CompressedRows {
 public:
  CompressedRows() : offsets_{0} {}

  /// offsets: n_rows + 1 ascending values starting at 0; the last one is entries.size().
  CompressedRows(std::vector<std::size_t> offsets, std::vector<T> entries)
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

  /// Position of a row's first entry in entries().
  std::size_t offset(std::size_t row) const { return offsets_[row]; }
  const std::vector<T>& entries() const { return entries_; }

  template <class Range>
  void append(const Range& row) {
    entries_.insert(entries_.end(), std::begin(row), std::end(row));
    offsets_.push_back(entries_.size());
  }

  bool operator==(const CompressedRows&) const = default;

 private:
  std::vector<std::size_t> offsets_;
  std::vector<T> entries_;
};

/// For each number below n_numbers, the rows that have it as an entry, ascending.
inline CompressedRows<std::uint32_t> rows_by_entry(const CompressedRows<std::uint32_t>& rows,
                                                   std::size_t n_numbers) {
  std::vector<std::size_t> offsets(n_numbers + 1, 0);
  for (const std::uint32_t number : rows.entries()) ++offsets[number + 1];
  for (std::size_t i = 0; i < n_numbers; ++i) offsets[i + 1] += offsets[i];
  std::vector<std::uint32_t> entries(rows.n_entries());
  auto next = offsets;
  for (std::uint32_t row = 0; row < rows.size(); ++row)
    for (const std::uint32_t number : rows[row]) entries[next[number]++] = row;
  return {std::move(offsets), std::move(entries)};
}

}  // namespace smoothfem
