#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "smoothing/mesh/compressed_rows.h"
#include "smoothing/mesh/parallel.h"

namespace smoothfem {

/// Rows made by several threads: make_row(i, row) fills an empty row, row after row within a part.
template <class T, class MakeRow>
CompressedRows<T> make_rows(std::size_t n_rows, const MakeRow& make_row) {
  constexpr std::size_t grain = 4096;  ///< rows that one thread makes at a time
  std::vector<std::vector<T>> parts((n_rows + grain - 1) / grain);
  std::vector<std::size_t> offsets(n_rows + 1, 0);
  parallel_for(parts.size(), [&](std::size_t part) {
    std::vector<T> row;
    for (std::size_t i = part * grain; i < std::min(n_rows, (part + 1) * grain); ++i) {
      row.clear();
      make_row(i, row);
      parts[part].insert(parts[part].end(), row.begin(), row.end());
      offsets[i + 1] = row.size();
    }
  });
  for (std::size_t i = 0; i < n_rows; ++i) offsets[i + 1] += offsets[i];
  std::vector<T> entries(offsets.back());
  parallel_for(parts.size(), [&](std::size_t part) {
    std::copy(parts[part].begin(), parts[part].end(), entries.begin() + offsets[part * grain]);
    std::vector<T>().swap(parts[part]);
  });
  return {std::move(offsets), std::move(entries)};
}

/// The same, making each row twice: once for its length. Needs no memory besides the result.
template <class T, class MakeRow>
CompressedRows<T> make_large_rows(std::size_t n_rows, const MakeRow& make_row) {
  std::vector<std::size_t> offsets(n_rows + 1, 0);
  const auto for_each_row = [&](const auto& use) {
    constexpr std::size_t grain = 4096;
    parallel_for_ranges(n_rows, grain, [&](std::size_t first, std::size_t last) {
      std::vector<T> row;
      for (std::size_t i = first; i < last; ++i) {
        row.clear();
        make_row(i, row);
        use(i, row);
      }
    });
  };
  for_each_row([&](std::size_t i, const std::vector<T>& row) { offsets[i + 1] = row.size(); });
  for (std::size_t i = 0; i < n_rows; ++i) offsets[i + 1] += offsets[i];
  std::vector<T> entries(offsets.back());
  for_each_row([&](std::size_t i, const std::vector<T>& row) {
    std::copy(row.begin(), row.end(), entries.begin() + static_cast<std::ptrdiff_t>(offsets[i]));
  });
  return {std::move(offsets), std::move(entries)};
}

}  // namespace smoothfem
