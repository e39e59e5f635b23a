// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <mpi.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <numeric>
#include <span>
#include <type_traits>
#include <vector>

#include "smoothing/parts/global_index.h"

namespace smoothfem {

/// The processes that work together on one finite element problem. A single process makes no MPI
/// calls, so that several threads may each have their own object.
class Ranks {
 public:
  /// This process alone.
  Ranks() = default;
  /// All processes of a communicator; MPI must have been initialized.
  explicit Ranks(MPI_Comm communicator);

  int size() const { return size_; }
  int rank() const { return rank_; }
  bool is_root() const { return rank_ == 0; }
  /// Returns MPI_COMM_SELF for one process.
  MPI_Comm communicator() const { return communicator_; }

  /// Compute sums and the largest value over all ranks, the same on each.
  void sum(std::span<double> values) const;
  void sum(std::span<std::int64_t> values) const;
  void min(std::span<double> values) const;
  void max(std::span<double> values) const;
  double sum(double value) const;
  std::size_t sum(std::size_t value) const;
  double max(double value) const;
  /// True if this holds on any rank.
  bool any(bool value) const { return sum(std::size_t{value}) > 0; }
  /// Returns the sum over the ranks before this one.
  std::size_t exclusive_scan(std::size_t value) const;
  /// Calls work() on the root. If it throws an InputError there, all ranks throw one. Collective.
  void on_root(const std::function<void()>& work) const;
  /// Calls work() on each rank. If it throws an InputError on some, all ranks throw that of the
  /// first one. Collective.
  void together(const std::function<void()>& work) const;
  /// Sends the root's value to all ranks.
  template <class T>
  void broadcast(T& value) const {
    static_assert(std::is_trivially_copyable_v<T>);
    broadcast_bytes(&value, sizeof(T));
  }
  /// Sends the root's values to all ranks, which need not know their number.
  template <class T>
  void broadcast(std::vector<T>& values) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::size_t n_values = values.size();
    broadcast(n_values);
    values.resize(n_values);
    broadcast_bytes(values.data(), n_values * sizeof(T));
  }
  /// Returns all ranks' values one after the other, on the root; empty elsewhere.
  template <class T>
  std::vector<T> gather(const std::vector<T>& values) const {
    if (size_ == 1) return values;
    const std::vector<int> counts = gather_counts(values.size());
    std::vector<T> all(static_cast<std::size_t>(std::accumulate(counts.begin(), counts.end(), 0L)));
    gather_items(values.data(), counts, sizeof(T), all.data(), values.size());
    return all;
  }
  /// Returns the items of all ranks, one rank's after the other's, on each: a vector or a string.
  /// Collective.
  template <class Items>
  Items gather_all(const Items& items) const {
    static_assert(std::is_trivially_copyable_v<typename Items::value_type>);
    const auto bytes = gather_all_bytes(std::as_bytes(std::span(items)));
    Items all;
    all.resize(bytes.size() / sizeof(typename Items::value_type));
    if (!bytes.empty()) std::memcpy(all.data(), bytes.data(), bytes.size());
    return all;
  }
  std::vector<std::byte> gather_all_bytes(std::span<const std::byte> bytes) const;
  /// Replaces ascending cells by the lowest ones of all ranks, the same on each. Each rank passes
  /// the same number of cells. Collective.
  void keep_lowest(std::span<KeyedCell> cells) const;
  /// Sends to[r] to each rank r; returns the items that each rank has sent to this one, in the
  /// order of the ranks. Frees `to`. Collective.
  template <class T>
  std::vector<std::vector<T>> exchange(std::vector<std::vector<T>> to) const {
    static_assert(std::is_trivially_copyable_v<T>);
    if (size_ == 1) return to;
    std::vector<std::size_t> counts;
    for (const auto& items : to) counts.push_back(items.size());
    std::vector<T> sent;
    sent.reserve(std::accumulate(counts.begin(), counts.end(), std::size_t{0}));
    for (auto& items : to) {
      sent.insert(sent.end(), items.begin(), items.end());
      std::vector<T>().swap(items);
    }
    const auto received_counts = exchange_counts(counts);
    std::vector<T> received(
        std::accumulate(received_counts.begin(), received_counts.end(), std::size_t{0}));
    exchange_items(sent.data(), counts, received.data(), received_counts, sizeof(T));
    std::size_t first = 0;
    for (std::size_t r = 0; r < received_counts.size(); ++r) {
      const auto begin = received.begin() + static_cast<std::ptrdiff_t>(first);
      to[r].assign(begin, begin + static_cast<std::ptrdiff_t>(received_counts[r]));
      first += received_counts[r];
    }
    return to;
  }
  /// Distributes the root's values, one rank's after the other's, n_values for this one.
  template <class T>
  std::vector<T> scatter(const std::vector<T>& all, std::size_t n_values) const {
    if (size_ == 1) return all;
    std::vector<T> values(n_values);
    scatter_items(all.data(), gather_counts(n_values), sizeof(T), values.data(), n_values);
    return values;
  }

 private:
  void broadcast_bytes(void* bytes, std::size_t n_bytes) const;
  std::vector<std::size_t> exchange_counts(const std::vector<std::size_t>& counts) const;
  void exchange_items(const void* sent, const std::vector<std::size_t>& counts, void* received,
                      const std::vector<std::size_t>& received_counts, std::size_t item_size) const;
  /// Returns every rank's count, on the root.
  std::vector<int> gather_counts(std::size_t n_values) const;
  void gather_items(const void* values, const std::vector<int>& counts, std::size_t item_size,
                    void* all, std::size_t n_values) const;
  void scatter_items(const void* all, const std::vector<int>& counts, std::size_t item_size,
                     void* values, std::size_t n_values) const;

  MPI_Comm communicator_ = MPI_COMM_SELF;
  int size_ = 1, rank_ = 0;
};

/// Distribution of a vector's entries. Each rank holds its own entries, followed by copies of other
/// ranks' entries that its equations contain.
class Halo {
 public:
  /// One process: nothing to exchange.
  Halo() = default;
  /// Collective. This rank's own entries have the numbers first_own .. first_own + n_own - 1 of
  /// n_total; ghosts: ascending numbers of others.
  Halo(const Ranks& ranks, std::size_t n_total, std::size_t first_own, std::size_t n_own,
       const std::vector<std::size_t>& ghosts);

  /// Fetches the copies from their owners. values: n_own + number of ghosts. Collective.
  void update(Eigen::VectorXd& values) const;
  /// Adds the copies to their owners' values. Collective.
  void add_to_owners(Eigen::VectorXd& values) const;

 private:
  struct Partition;
  std::shared_ptr<const Partition> partition_;  ///< empty: one process
};

}  // namespace smoothfem
