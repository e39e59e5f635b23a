// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "smoothing/base/parallel.h"

namespace smoothfem {

/// Finds the lowest of many changing keys, by a tournament among the numbers 0 .. n-1. The lowest
/// key wins; ties go to the lower number. A changed key replays the rounds of its number and stops
/// where it neither won nor wins. Keys that are not among the lowest need few rounds.
class MinTree {
 public:
  /// Infinite key: it never wins against a finite one.
  static constexpr double never = std::numeric_limits<double>::infinity();

  void build(std::vector<double> keys) {
    keys_ = std::move(keys);
    levels_.clear();
    for (std::size_t size = keys_.size(); size > 1;) {
      const std::size_t next = (size + width - 1) / width;
      levels_.emplace_back(next);
      const std::size_t level = levels_.size() - 1;
      parallel_for_ranges(next, grain, [&](std::size_t first, std::size_t last) {
        for (std::size_t group = first; group < last; ++group)
          levels_[level][group] = play(level, group);
      });
      size = next;
    }
  }

  std::size_t size() const { return keys_.size(); }
  /// True if no number has a finite key.
  bool empty() const { return keys_.empty() || keys_[top()] == never; }
  /// Returns the number with the lowest key. Requires size() > 0.
  std::uint32_t top() const {
    assert(!keys_.empty());
    return levels_.empty() ? 0 : levels_.back()[0];
  }
  double key(std::uint32_t number) const { return keys_[number]; }

  void update(std::uint32_t number, double key) {
    const double old = keys_[number];
    keys_[number] = key;
    std::size_t group = number;
    for (std::size_t level = 0; level < levels_.size(); ++level) {
      group /= width;
      std::uint32_t& winner = levels_[level][group];
      if (winner == number) {
        if (key > old) winner = play(level, group);
      } else if (before(number, winner)) {
        winner = number;
      } else {
        return;
      }
    }
  }

 private:
  static constexpr std::size_t width = 8;     ///< players in one round
  static constexpr std::size_t grain = 4096;  ///< rounds that one thread plays at a time

  bool before(std::uint32_t a, std::uint32_t b) const {
    return keys_[a] < keys_[b] || (keys_[a] == keys_[b] && a < b);
  }
  /// Returns the winner of a group. Players come in the order of their numbers, so that ties
  /// resolve themselves.
  std::uint32_t play(std::size_t level, std::size_t group) const {
    const std::size_t n = level == 0 ? keys_.size() : levels_[level - 1].size();
    const std::size_t last = std::min(n, (group + 1) * width);
    const auto player = [&](std::size_t i) {
      return level == 0 ? static_cast<std::uint32_t>(i) : levels_[level - 1][i];
    };
    std::uint32_t best = player(group * width);
    for (std::size_t i = group * width + 1; i < last; ++i)
      if (keys_[player(i)] < keys_[best]) best = player(i);
    return best;
  }

  std::vector<double> keys_;
  std::vector<std::vector<std::uint32_t>> levels_;  ///< winners of the groups of the level below
};

}  // namespace smoothfem
