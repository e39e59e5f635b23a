// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace smoothfem {

/// Parts of a mesh, in groups that several threads may process at a time: no part of a group writes
/// where another part of it reads or writes. The groups depend on the mesh alone. So the order in
/// which parts add to a node is the same for every number of threads.
using DisjointGroups = std::vector<std::vector<std::size_t>>;

/// The indices first .. last-1.
struct IndexRange {
  std::size_t first, last;

  bool overlaps(const IndexRange& other) const { return first < other.last && other.first < last; }
};

/// Assigns parts 0 .. n-1 to groups, each to the first group where it fits. written(p) and read(p):
/// the ranges of nodes that part p writes and reads; the latter includes the former.
template <class Written, class Read>
DisjointGroups disjoint_groups(std::size_t n, const Written& written, const Read& read) {
  DisjointGroups groups;
  for (std::size_t p = 0; p < n; ++p) {
    const auto fits = [&](const std::vector<std::size_t>& group) {
      return std::none_of(group.begin(), group.end(), [&](std::size_t q) {
        return written(p).overlaps(read(q)) || written(q).overlaps(read(p));
      });
    };
    const auto found = std::find_if(groups.begin(), groups.end(), fits);
    if (found == groups.end())
      groups.push_back({p});
    else
      found->push_back(p);
  }
  return groups;
}

}  // namespace smoothfem
