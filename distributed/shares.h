// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "fem/ranks/ranks.h"

namespace smoothfem {

/// Returns the first of n items that a rank handles: n r / P, of P ranks. Its share ends where that
/// of the next rank begins.
inline std::uint64_t first_of_share(const Ranks& ranks, std::uint64_t n, int rank) {
  return n * static_cast<std::uint64_t>(rank) / static_cast<std::uint64_t>(ranks.size());
}

/// Calls visit(rank, its values) on the root, for one rank after the other, so that the root never
/// has the values of two others. Collective. Throws an InputError of visit on all ranks.
template <class T, class Visit>
void visit_in_turn(const Ranks& ranks, std::vector<T> values, const Visit& visit) {
  for (int rank = 0; rank < ranks.size(); ++rank) {
    std::vector<std::vector<T>> to(static_cast<std::size_t>(ranks.size()));
    if (rank == ranks.rank()) to[0] = std::move(values);
    const auto from = ranks.exchange(std::move(to));
    ranks.on_root([&] { visit(rank, from[static_cast<std::size_t>(rank)]); });
  }
}

}  // namespace smoothfem
