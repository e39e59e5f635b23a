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

}  // namespace smoothfem
