// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "smoothing/optimization/cell_derivatives.h"
#include "smoothing/simd/lanes.h"

namespace smoothfem {

/// A block of one cell, ready to be added: n_lanes entries at a time, and the last one alone if the
/// number of entries is odd.
template <int dim, class Number>
struct AddedBlock {
  using NumberLanes = typename ArrayLanes<Number>::Values;
  NumberLanes first{}, second{};
  Number last{};

  void add_to(Number* sum) const {
    store_lanes(load_lanes(sum) + first, sum);
    if constexpr (dim == 3) {
      store_lanes(load_lanes(sum + n_lanes) + second, sum + n_lanes);
      sum[2 * n_lanes] += last;
    }
  }
  AddedBlock transpose() const {
    if constexpr (dim == 2)
      return {__builtin_shufflevector(first, first, 0, 2, 1, 3)};
    else
      return {__builtin_shufflevector(first, second, 0, 3, 6, 1),
              __builtin_shufflevector(first, second, 4, 7, 2, 5), last};
  }
};

/// Returns the blocks of n_lanes cells, or of one cell, by cell.
template <class Number, int dim>
inline auto added_blocks(const Block<dim, Lanes>& block) {
  using Added = AddedBlock<dim, Number>;
  const auto entries = [&](std::size_t k) {
    return __builtin_convertvector(block.entries[k], typename Added::NumberLanes);
  };
  std::array<Added, n_lanes> result;
  const auto first = transposed(entries(0), entries(1), entries(2), entries(3));
  for (std::size_t l = 0; l < n_lanes; ++l) result[l].first = first[l];
  if constexpr (dim == 3) {
    const auto second = transposed(entries(4), entries(5), entries(6), entries(7));
    for (std::size_t l = 0; l < n_lanes; ++l) {
      result[l].second = second[l];
      result[l].last = static_cast<Number>(block.entries[8][l]);
    }
  }
  return result;
}
template <class Number, int dim>
inline auto added_blocks(const Block<dim, double>& block) {
  using Added = AddedBlock<dim, Number>;
  const auto entries = [&](std::size_t k) {
    return __builtin_convertvector(load_lanes(block.entries.data() + k),
                                   typename Added::NumberLanes);
  };
  Added result{entries(0)};
  if constexpr (dim == 3) {
    result.second = entries(n_lanes);
    result.last = static_cast<Number>(block.entries[2 * n_lanes]);
  }
  return std::array{result};
}

/// Returns a b c' for lower triangular a and c.
template <int dim, class Real>
inline Block<dim, Real> scaled(const Block<dim, Real>& a, const Block<dim, Real>& b,
                               const Block<dim, Real>& c) {
  Block<dim, Real> left, result;
  for (std::size_t j = 0; j < dim; ++j)
    for (std::size_t i = 0; i < dim; ++i)
      for (std::size_t k = 0; k <= i; ++k)
        left.entries[dim * j + i] += a.entries[dim * k + i] * b.entries[dim * j + k];
  for (std::size_t j = 0; j < dim; ++j)
    for (std::size_t i = 0; i < dim; ++i)
      for (std::size_t k = 0; k <= j; ++k)
        result.entries[dim * j + i] += left.entries[dim * k + i] * c.entries[dim * k + j];
  return result;
}

}  // namespace smoothfem
