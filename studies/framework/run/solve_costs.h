// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace smoothfem {

/// A task. Tasks with the same key() are of one kind, and cost about the same.
struct SolveKind {
  std::size_t mesh, method, degree;  ///< any distinct numbers
  bool is_initial, is_result;
  double n_nodes;
  int dimension;
  int polynomial_degree;
  std::size_t record = 0;  ///< of the method: its number within the kind

  auto key() const { return std::tuple(mesh, method, degree, is_result); }
};

/// Returns the two of a job's n records that represent the cost of all. Meshes get better and
/// cheaper to solve, fast at first and slowly later. So the records are the points of the two-point
/// Gauss rule.
inline std::array<std::size_t, 2> representative_records(std::size_t n) {
  constexpr double gauss_point = 0.2113248654051871;  // (1 - 1 / sqrt(3)) / 2
  const auto at = static_cast<std::size_t>(gauss_point * static_cast<double>(n));
  return {at, n - 1 - at};
}

/// Estimates the time of finite element tasks from finished tasks. The logarithm of the seconds is
/// a sum. One part follows from the size of the system. The other parts are effects of the mesh,
/// the method, the degree, and of being a result.
/// Effects are fitted by least squares, in which a zero weighs as much as a few tasks. They are
/// zero as long as nothing is known.
/// The initial mesh counts as a method. It may take ten times as long as others, because its
/// condition number is the hardest to find.
class SolveCosts {
 public:
  /// Adds a finished task with its seconds.
  void add(const SolveKind& kind, double seconds);

  /// Adds a task that is still to be done, or removes it.
  void expect(const SolveKind& kind) {
    open_.try_emplace(kind.key(), kind, std::set<std::size_t>())
        .first->second.second.insert(kind.record);
  }
  void forget(const SolveKind& kind) { open_.at(kind.key()).second.erase(kind.record); }

  /// Returns the expected seconds of all tasks to do, one after the other.
  double seconds_to_come() const;

  /// Returns the expected seconds of one task, between those of the known records of its kind
  /// before and after it. Without any known record, it is right within a factor of about ten.
  double expected(const SolveKind& kind) const;

 private:
  struct Known {
    SolveKind kind;
    std::map<std::size_t, double> seconds{};  ///< by record

    double mean() const;
    double at(std::size_t record) const;
  };
  using Effect =
      std::pair<std::size_t, std::size_t>;  ///< source (0 all, 1 mesh, 2 method, ...) and its index

  static double base(const SolveKind& kind);
  static std::array<Effect, 6> effects_of(const SolveKind& kind);
  void fit() const;

  using Key = decltype(SolveKind{}.key());

  std::map<Key, Known> known_;
  std::map<Key, std::pair<SolveKind, std::set<std::size_t>>> open_;  ///< and the records
  mutable std::map<Effect, double> effects_;                         ///< as last fitted
  mutable bool fitted_ = true;
};

}  // namespace smoothfem
