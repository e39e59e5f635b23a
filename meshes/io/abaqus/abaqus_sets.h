// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "meshes/io/label_range.h"

namespace smoothfem {

/// The sets of each of some elements. Elements with the same sets share a combination.
struct SetCombinations {
  std::vector<std::vector<std::size_t>> sets{{}};  ///< of each combination; the first has none
  std::vector<std::uint32_t> of_element;           ///< the combination of each element
  bool is_complete = true;  ///< false if there are too many sets, and later ones are left out
};

/// Finds the sets that contain elements. labels: of the elements, ascending. own: the set that the
/// keyword of each element names, or 0; it comes first. ranges: of the members of sets, which then
/// come in ascending order. A file with many sets of many elements takes bounded time and memory.
SetCombinations combine_sets(const std::vector<std::size_t>& labels,
                             const std::vector<std::size_t>& own,
                             std::vector<std::pair<LabelRange, std::size_t>> ranges);

}  // namespace smoothfem
