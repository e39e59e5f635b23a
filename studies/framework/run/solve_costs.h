// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <tuple>
#include <utility>

namespace smoothfem {

/// Tasks that cost about the same.
struct SolveKind {
  std::size_t mesh, method, degree;  ///< any numbers that tell them apart
  bool is_initial, is_result;
  double n_nodes;
  int dimension;
  int polynomial_degree;

  auto key() const { return std::tuple(mesh, method, degree, is_result); }
};

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
    ++open_.try_emplace(kind.key(), kind, 0).first->second.second;
  }
  void forget(const SolveKind& kind) { --open_.at(kind.key()).second; }

  /// Expected seconds of all tasks to come, one after the other.
  double seconds_to_come() const;

  /// Expected seconds of one task. Before the first one is known: right within a factor of ten or
  /// so.
  double expected(const SolveKind& kind) const;

 private:
  struct Known {
    SolveKind kind;
    std::size_t n = 0;
    double seconds = 0.0;
  };
  using Effect =
      std::pair<std::size_t, std::size_t>;  ///< what of: 0 all, 1 mesh, 2 method, ...; which

  static double base(const SolveKind& kind);
  static std::array<Effect, 6> effects_of(const SolveKind& kind);
  void fit() const;

  using Key = decltype(SolveKind{}.key());

  std::map<Key, Known> known_;
  std::map<Key, std::pair<SolveKind, std::size_t>> open_;  ///< and how many of the kind
  mutable std::map<Effect, double> effects_;               ///< as last fitted
  mutable bool fitted_ = true;
};

}  // namespace smoothfem
