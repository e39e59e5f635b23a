// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "smoothing/base/parallel.h"
#include "smoothing/mesh/compressed_rows.h"

namespace smoothfem {

/// Makes rows by several threads: make_row(i, row) fills an empty row. Works in batches, so that
/// tables larger than the mesh need hardly any additional memory. Throws InputError if there are
/// too many entries.
template <class T, class MakeRow>
CompressedRows<T> make_rows(std::size_t n_rows, const MakeRow& make_row) {
  constexpr std::size_t grain = 4096;  // rows that one thread makes at a time
  constexpr std::size_t rows_a_batch = 64 * grain;
  constexpr double spare = 1.25;  // costs only addresses, as long as nothing is written there
  std::vector<RowOffset> lengths(n_rows + 1, 0);
  std::vector<T> entries;
  std::vector<std::vector<T>> parts(std::min(n_rows, rows_a_batch) / grain + 1);
  for (std::size_t begin = 0; begin < n_rows; begin += rows_a_batch) {
    const std::size_t end = std::min(n_rows, begin + rows_a_batch);
    parallel_for((end - begin + grain - 1) / grain, [&](std::size_t p) {
      const std::size_t first = begin + p * grain;
      std::vector<T> row;
      for (std::size_t i = first; i < std::min(end, first + grain); ++i) {
        row.clear();
        make_row(i, row);
        parts[p].insert(parts[p].end(), row.begin(), row.end());
        lengths[i + 1] = static_cast<RowOffset>(row.size());
      }
    });
    std::size_t n_new = 0;
    for (const auto& part : parts) n_new += part.size();
    if (entries.size() + n_new > entries.capacity()) {
      const double mean_length =
          static_cast<double>(entries.size() + n_new) / static_cast<double>(end);
      entries.reserve(end == n_rows ? entries.size() + n_new
                                    : static_cast<std::size_t>(spare * mean_length *
                                                               static_cast<double>(n_rows)));
    }
    for (auto& part : parts) {
      entries.insert(entries.end(), part.begin(), part.end());
      part.clear();
    }
  }
  return {row_offsets(std::move(lengths)), std::move(entries)};
}

}  // namespace smoothfem
