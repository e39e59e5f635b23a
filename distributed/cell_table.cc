// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/cell_table.h"

#include <algorithm>
#include <numeric>

namespace smoothfem {

void sort_by_numbers(CellTable& table) {
  if (std::is_sorted(table.numbers.begin(), table.numbers.end())) return;
  std::vector<std::uint32_t> order(table.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return table.numbers[a] < table.numbers[b]; });
  CellTable sorted;
  sorted.reserve(table.size(), table.corners.size());
  for (const std::uint32_t c : order) sorted.append(table.numbers[c], table.materials[c], table[c]);
  table = std::move(sorted);
}

std::vector<std::uint8_t> merge_into(CellTable& table, const CellTable& others) {
  std::size_t left = table.size(), left_others = others.size();
  const std::size_t n = left + left_others;
  std::size_t end = table.corners.size() + others.corners.size();
  require_countable(end);
  std::vector<std::uint8_t> was_there(n, 1);
  table.numbers.resize(n);
  table.materials.resize(n);
  table.offsets.resize(n + 1);
  table.corners.resize(end);
  // From the last cell to the first, so that nothing is overwritten before it is moved.
  for (std::size_t c = n; c-- > 0;) {
    const bool is_other =
        left_others > 0 && (left == 0 || others.numbers[left_others - 1] > table.numbers[left - 1]);
    const CellTable& from = is_other ? others : table;
    const std::size_t at = is_other ? --left_others : --left;
    const std::size_t size = from.offsets[at + 1] - from.offsets[at];
    const auto first = from.corners.begin() + from.offsets[at];
    std::copy_backward(first, first + static_cast<std::ptrdiff_t>(size),
                       table.corners.begin() + static_cast<std::ptrdiff_t>(end));
    table.numbers[c] = from.numbers[at];
    table.materials[c] = from.materials[at];
    table.offsets[c + 1] = static_cast<RowOffset>(end);
    was_there[c] = !is_other;
    end -= size;
    if (left_others == 0) break;  // all cells before are in their places
  }
  return was_there;
}

CellTable sorted_cells(const std::vector<std::vector<GlobalIndex>>& words, std::size_t n_more) {
  std::vector<const GlobalIndex*> cells;
  for (const auto& of_rank : words)
    for (std::size_t at = 0; at < of_rank.size(); at += 3 + (1 + n_more) * of_rank[at + 2])
      cells.push_back(&of_rank[at]);
  std::sort(cells.begin(), cells.end(),
            [](const GlobalIndex* a, const GlobalIndex* b) { return *a < *b; });
  CellTable table;
  for (const GlobalIndex* cell : cells)
    table.append(cell[0], static_cast<int>(cell[1]), {cell + 3, cell[2]});
  return table;
}

}  // namespace smoothfem
