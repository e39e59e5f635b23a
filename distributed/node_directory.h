// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "distributed/shares.h"
#include "fem/ranks/ranks.h"
#include "smoothing/mesh/fixed_reason.h"
#include "smoothing/mesh/point.h"
#include "smoothing/parts/global_index.h"

namespace smoothfem {

/// What any rank can ask about the nodes of a distributed mesh. Rank r keeps the entries of the
/// numbers from n r / P to n (r+1) / P - 1, with n numbers and P ranks.
template <class Entry>
class NodeDirectory {
 public:
  /// Collective, as all functions here. n: one more than the largest number of a node.
  NodeDirectory(const Ranks& ranks, std::size_t n) : ranks_(ranks), n_(n) {
    entries_.resize(first_of(ranks.rank() + 1) - first_of(ranks.rank()));
  }

  std::size_t n() const { return n_; }
  /// Entries that this rank keeps, and the number of the first one.
  std::vector<Entry>& entries() { return entries_; }
  const std::vector<Entry>& entries() const { return entries_; }
  std::size_t first() const { return first_of(ranks_.rank()); }

  /// Returns the rank that keeps the entry of a number. Not collective.
  std::size_t keeper_of(GlobalIndex number) const {
    auto rank =
        static_cast<int>(std::size_t{number} * static_cast<std::size_t>(ranks_.size()) / n_);
    while (number < first_of(rank)) --rank;
    while (number >= first_of(rank + 1)) ++rank;
    return static_cast<std::size_t>(rank);
  }

  /// Calls merge(kept entry, given entry, rank it comes from) for the entries that ranks give for
  /// some numbers, in the order of the ranks.
  template <class Merge>
  void give(std::span<const GlobalIndex> numbers, std::span<const Entry> given,
            const Merge& merge) {
    struct Item {
      GlobalIndex number;
      Entry entry;
    };
    std::vector<std::vector<Item>> to(static_cast<std::size_t>(ranks_.size()));
    for (std::size_t i = 0; i < numbers.size(); ++i)
      to[keeper_of(numbers[i])].push_back({numbers[i], given[i]});
    const auto from = ranks_.exchange(std::move(to));
    for (std::size_t r = 0; r < from.size(); ++r)
      for (const Item& item : from[r])
        merge(entries_[item.number - first()], item.entry, static_cast<int>(r));
  }

  /// Calls visit(kept entry, rank) for the numbers that ranks name, in the order of the ranks.
  template <class Visit>
  void name(std::span<const GlobalIndex> numbers, const Visit& visit) {
    const auto named = ranks_.exchange(by_keeper(numbers));
    for (std::size_t r = 0; r < named.size(); ++r)
      for (const GlobalIndex number : named[r])
        visit(entries_[number - first()], static_cast<int>(r));
  }

  /// Returns part(entry) of the entries of some numbers.
  template <class Part>
  auto ask(std::span<const GlobalIndex> numbers, const Part& part) const {
    using Answer = std::decay_t<decltype(part(entries_.front()))>;
    std::vector<std::vector<Answer>> answers(static_cast<std::size_t>(ranks_.size()));
    {
      const auto asked = ranks_.exchange(by_keeper(numbers));
      for (std::size_t r = 0; r < asked.size(); ++r) {
        answers[r].reserve(asked[r].size());
        for (const GlobalIndex number : asked[r])
          answers[r].push_back(part(entries_[number - first()]));
      }
    }
    const auto from = ranks_.exchange(std::move(answers));
    std::vector<std::size_t> next(from.size(), 0);
    std::vector<Answer> result;
    result.reserve(numbers.size());
    for (const GlobalIndex number : numbers) {
      const std::size_t r = keeper_of(number);
      result.push_back(from[r][next[r]++]);
    }
    return result;
  }

 private:
  std::vector<std::vector<GlobalIndex>> by_keeper(std::span<const GlobalIndex> numbers) const {
    std::vector<std::vector<GlobalIndex>> result(static_cast<std::size_t>(ranks_.size()));
    for (const GlobalIndex number : numbers) result[keeper_of(number)].push_back(number);
    return result;
  }
  std::size_t first_of(int rank) const { return first_of_share(ranks_, n_, rank); }
  Ranks ranks_;
  std::size_t n_;
  std::vector<Entry> entries_;
};

/// A node of the whole mesh, as the directory keeps it.
template <int dim>
struct NodeEntry {
  std::array<double, static_cast<std::size_t>(dim)> x{};
  FixedReasons reasons = 0;
  static constexpr int not_given = -1, given = -2;
  int owner = not_given;  ///< a rank, or given: no rank owns it yet; or no file has the node

  Point<dim> point() const { return Point<dim>(x.data()); }
};
template <int dim>
NodeEntry<dim> node_entry(const Point<dim>& point, FixedReasons reasons) {
  NodeEntry<dim> entry{.reasons = reasons, .owner = NodeEntry<dim>::given};
  for (std::size_t d = 0; d < dim; ++d) entry.x[d] = point[static_cast<Eigen::Index>(d)];
  return entry;
}

}  // namespace smoothfem
