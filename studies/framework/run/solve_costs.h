// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace smoothfem {

/// A task; those with the same key() are of one kind, and cost about the same.
struct SolveKind {
  std::size_t mesh, method, degree;  ///< any numbers that tell them apart
  bool is_initial, is_result;
  double n_nodes;
  int dimension;
  int polynomial_degree;
  std::size_t record = 0;  ///< of the method: which one of the kind it is

  auto key() const { return std::tuple(mesh, method, degree, is_result); }
};

/// Which of a job's n records tell what all of them cost: meshes get better, and cheaper to solve,
/// fast at first and slowly then, so those of the Gauss rule with two points.
inline std::array<std::size_t, 2> representative_records(std::size_t n) {
  constexpr double gauss_point = 0.2113248654051871;  // (1 - 1 / sqrt(3)) / 2
  const auto at = static_cast<std::size_t>(gauss_point * static_cast<double>(n));
  return {at, n - 1 - at};
}

/// How long finite element tasks take, learned from those that are done. The logarithm of the
/// seconds is taken for a sum: of a part that follows from the size of the system, and of what each
/// mesh, method and degree, and being a result, adds to it; these are zero as long as nothing is
/// known, and fitted by least squares, in which a zero weighs as much as a few tasks. The initial
/// mesh, a method of its own here, may take ten times as long as others: its condition number is
/// the hardest to find.
class SolveCosts {
 public:
  /// A task that took so long.
  void add(const SolveKind& kind, double seconds);

  /// A task that is still to come, and that it is none any more.
  void expect(const SolveKind& kind) {
    open_.try_emplace(kind.key(), kind, std::set<std::size_t>())
        .first->second.second.insert(kind.record);
  }
  void forget(const SolveKind& kind) { open_.at(kind.key()).second.erase(kind.record); }

  /// Expected seconds of all tasks to come, one after the other.
  double seconds_to_come() const;

  /// Expected seconds of one task: between those of the records of its kind that are known before
  /// and after it. Before the first one of any kind is known: right within a factor of ten or so.
  double expected(const SolveKind& kind) const;

 private:
  struct Known {
    SolveKind kind;
    std::map<std::size_t, double> seconds{};  ///< by record

    double mean() const;
    double at(std::size_t record) const;
  };
  using Effect =
      std::pair<std::size_t, std::size_t>;  ///< what of: 0 all, 1 mesh, 2 method, ...; which

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
