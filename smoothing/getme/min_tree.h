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

  /// Returns the n numbers with the lowest keys in their order, or all with finite keys if these
  /// are fewer. Requires size() > 0.
  std::vector<std::uint32_t> lowest(std::size_t n) const {
    // The winner of a group is known. Once it is taken, the other players of its rounds can be
    // next.
    struct Contender {
      std::uint32_t number;
      std::size_t level;  ///< it won all rounds below
    };
    const auto after = [this](const Contender& a, const Contender& b) {
      return before(b.number, a.number);
    };
    std::vector<Contender> contenders{{top(), levels_.size()}};
    std::vector<std::uint32_t> taken;
    while (taken.size() < n && !contenders.empty()) {
      std::pop_heap(contenders.begin(), contenders.end(), after);
      const Contender first = contenders.back();
      contenders.pop_back();
      if (keys_[first.number] == never) break;
      taken.push_back(first.number);
      std::size_t group = first.number;
      for (std::size_t level = 0; level < first.level; ++level) {
        group /= width;
        for (std::size_t i = group * width; i < end_of(level, group); ++i) {
          if (player(level, i) == first.number) continue;
          contenders.push_back({player(level, i), level});
          std::push_heap(contenders.begin(), contenders.end(), after);
        }
      }
    }
    return taken;
  }

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
    const std::size_t last = end_of(level, group);
    std::uint32_t best = player(level, group * width);
    for (std::size_t i = group * width + 1; i < last; ++i)
      if (keys_[player(level, i)] < keys_[best]) best = player(level, i);
    return best;
  }
  /// Players of a group are those from group * width to its end.
  std::size_t end_of(std::size_t level, std::size_t group) const {
    const std::size_t n = level == 0 ? keys_.size() : levels_[level - 1].size();
    return std::min(n, (group + 1) * width);
  }
  std::uint32_t player(std::size_t level, std::size_t i) const {
    return level == 0 ? static_cast<std::uint32_t>(i) : levels_[level - 1][i];
  }

  std::vector<double> keys_;
  std::vector<std::vector<std::uint32_t>> levels_;  ///< winners of the groups of the level below
};

}  // namespace smoothfem
