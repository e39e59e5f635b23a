// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/abaqus/abaqus_sets.h"

#include <algorithm>
#include <unordered_map>

namespace smoothfem {

namespace {

/// A combination while sets are added: another combination, and one set more.
struct Growing {
  std::uint32_t rest;
  std::size_t first, last;  ///< of its sets; 0 if it has none
};

class Combiner {
 public:
  explicit Combiner(std::size_t n_elements) : of_element_(n_elements, 0) {}

  /// Adds a set to the combination of an element.
  void add(std::size_t element, std::size_t set) {
    if (set != last_set_) children_.clear();
    last_set_ = set;
    const std::uint32_t old = of_element_[element];
    if (all_[old].first == set || all_[old].last == set) return;
    const auto [child, is_new] =
        children_.try_emplace(old, static_cast<std::uint32_t>(all_.size()));
    if (is_new) all_.push_back({old, old == 0 ? set : all_[old].first, set});
    of_element_[element] = child->second;
  }

  SetCombinations combinations() && {
    SetCombinations result;
    std::vector<std::uint32_t> numbers(all_.size(), 0);
    for (const std::uint32_t c : of_element_) {
      if (c != 0 && numbers[c] == 0) {
        numbers[c] = static_cast<std::uint32_t>(result.sets.size());
        result.sets.push_back(sets_of(c));
      }
      result.of_element.push_back(numbers[c]);
    }
    return result;
  }

 private:
  std::vector<std::size_t> sets_of(std::uint32_t combination) const {
    std::vector<std::size_t> sets;
    for (; combination != 0; combination = all_[combination].rest)
      sets.push_back(all_[combination].last);
    std::reverse(sets.begin(), sets.end());
    return sets;
  }

  std::vector<Growing> all_{{0, 0, 0}};
  std::vector<std::uint32_t> of_element_;
  std::unordered_map<std::uint32_t, std::uint32_t> children_;  ///< with the set added last
  std::size_t last_set_ = 0;
};

}  // namespace

SetCombinations combine_sets(const std::vector<std::size_t>& labels,
                             const std::vector<std::size_t>& own,
                             std::vector<std::pair<LabelRange, std::size_t>> ranges) {
  constexpr std::size_t most_for_each = 64, most_of_few = 1'000'000;
  const std::size_t most = std::max(most_of_few, most_for_each * labels.size());
  Combiner combiner(labels.size());
  std::vector<std::size_t> elements(labels.size());
  for (std::size_t i = 0; i < elements.size(); ++i) elements[i] = i;
  std::stable_sort(elements.begin(), elements.end(),
                   [&](std::size_t a, std::size_t b) { return own[a] < own[b]; });
  for (const std::size_t i : elements)
    if (own[i] != 0) combiner.add(i, own[i]);
  std::stable_sort(ranges.begin(), ranges.end(),
                   [](const auto& a, const auto& b) { return a.second < b.second; });
  std::size_t n_members = 0;
  for (const auto& [range, set] : ranges) {
    if (n_members > most) break;
    for_each_in_range(labels, range, [&, set = set](std::size_t i) {
      ++n_members;
      combiner.add(i, set);
    });
  }
  auto result = std::move(combiner).combinations();
  result.is_complete = n_members <= most;
  return result;
}

}  // namespace smoothfem
