// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/doctor/examinations/same_cells.h"

#include <algorithm>
#include <boost/container_hash/hash.hpp>

namespace smoothfem {

namespace {

std::vector<NodeIndex> sorted(std::span<const NodeIndex> row) {
  std::vector<NodeIndex> nodes(row.begin(), row.end());
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

/// Returns the rows that are equal to an earlier row, ascending. normal(row): the row to compare.
template <class Normal>
std::vector<std::uint32_t> repeated_rows(const CompressedRows<NodeIndex>& rows,
                                         const Normal& normal) {
  std::vector<std::pair<std::size_t, std::uint32_t>> keys(rows.size());
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    const auto row = normal(rows[i]);
    keys[i] = {boost::hash_range(row.begin(), row.end()), i};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> found;
  for (std::size_t first = 0, last = 0; first < keys.size(); first = last) {
    while (last < keys.size() && keys[last].first == keys[first].first) ++last;
    for (std::size_t k = first + 1; k < last; ++k)
      for (std::size_t earlier = first; earlier < k; ++earlier)
        if (std::ranges::equal(normal(rows[keys[k].second]), normal(rows[keys[earlier].second]))) {
          found.push_back(keys[k].second);
          break;
        }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

std::vector<std::uint32_t> collapsed_cells(const CompressedRows<NodeIndex>& cells) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t c = 0; c < cells.size(); ++c) {
    const auto nodes = sorted(cells[c]);
    if (std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end()) found.push_back(c);
  }
  return found;
}

std::vector<std::uint32_t> doubled_cells(const CompressedRows<NodeIndex>& cells) {
  return repeated_rows(cells, sorted);
}

std::vector<std::uint32_t> equal_rows(const CompressedRows<NodeIndex>& rows) {
  return repeated_rows(rows, [](std::span<const NodeIndex> row) { return row; });
}

}  // namespace smoothfem
