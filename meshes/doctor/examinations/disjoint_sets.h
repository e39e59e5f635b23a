// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace smoothfem {

/// Sets of the numbers 0, 1, ..., joined step by step. Each member is turned or not, relative to
/// the first member of its set.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parents_(n), turned_(n, 0) {
    std::iota(parents_.begin(), parents_.end(), std::uint32_t{0});
  }

  struct Place {
    std::uint32_t first;  ///< smallest member of the set
    bool turned;          ///< relative to it
  };

  Place place_of(std::uint32_t i) {
    std::uint32_t first = i;
    std::uint8_t turned = 0;
    for (; parents_[first] != first; first = parents_[first]) turned ^= turned_[first];
    const Place place{first, turned != 0};
    while (parents_[i] != first) {  // the next search from here is short
      const std::uint32_t next = parents_[i];
      const std::uint8_t of_rest = turned ^ turned_[i];
      parents_[i] = first;
      turned_[i] = turned;
      turned = of_rest;
      i = next;
    }
    return place;
  }
  std::uint32_t first_of(std::uint32_t i) { return place_of(i).first; }

  /// Joins the sets of a and b. turned: whether a and b are turned relative to each other. False if
  /// they are in one set already, with the opposite relation.
  bool join(std::uint32_t a, std::uint32_t b, bool turned = false) {
    const Place of_a = place_of(a), of_b = place_of(b);
    const bool between = (of_a.turned != of_b.turned) != turned;
    if (of_a.first == of_b.first) return !between;
    const bool a_is_first = of_a.first < of_b.first;
    const std::uint32_t low = a_is_first ? of_a.first : of_b.first,
                        high = a_is_first ? of_b.first : of_a.first;
    parents_[high] = low;
    turned_[high] = between ? 1 : 0;
    return true;
  }

 private:
  std::vector<std::uint32_t> parents_;
  std::vector<std::uint8_t> turned_;  ///< relative to the parent
};

}  // namespace smoothfem
