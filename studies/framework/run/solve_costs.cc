// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/solve_costs.h"

#include <Eigen/Dense>
#include <cmath>
#include <iterator>

namespace smoothfem {

void SolveCosts::add(const SolveKind& kind, double seconds) {
  known_.try_emplace(kind.key(), Known{kind}).first->second.seconds[kind.record] = seconds;
  fitted_ = false;
}

double SolveCosts::Known::mean() const {
  double sum = 0.0;
  for (const auto& [record, value] : seconds) sum += value;
  return sum / static_cast<double>(seconds.size());
}

double SolveCosts::Known::at(std::size_t record) const {
  const auto after = seconds.lower_bound(record);
  if (after == seconds.begin()) return after->second;
  const auto before = std::prev(after);
  if (after == seconds.end()) return before->second;
  const double share = static_cast<double>(record - before->first) /
                       static_cast<double>(after->first - before->first);
  return before->second + share * (after->second - before->second);
}

/// Logarithm of the seconds that a system of this size takes on a common machine.
double SolveCosts::base(const SolveKind& kind) {
  constexpr double exponent = 1.25;  // of work by the number of unknowns: CG, sparse factorization
  const double n_dofs = kind.n_nodes * std::pow(kind.polynomial_degree, kind.dimension);
  const double seconds_at_1000_dofs = kind.dimension == 2 ? 4e-3 : 1.2e-2;
  return std::log(seconds_at_1000_dofs) + exponent * std::log(n_dofs / 1000.0);
}

std::array<SolveCosts::Effect, 6> SolveCosts::effects_of(const SolveKind& kind) {
  return {{{0, 0},
           {1, kind.mesh},
           {2, kind.method},
           {3, kind.degree},
           {4, kind.is_result},
           {5, kind.is_initial}}};
}

void SolveCosts::fit() const {
  if (fitted_) return;
  fitted_ = true;
  std::map<Effect, Eigen::Index> columns;
  for (const auto& [key, known] : known_)
    for (const Effect& effect : effects_of(known.kind))
      columns.try_emplace(effect, static_cast<Eigen::Index>(columns.size()));
  const auto n = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  // Weights are in units of the scatter of one task: a factor of 1.2. Effects are expected within a
  // factor of 2, the machine's within 5, and an initial mesh's within 10.
  constexpr double scatter = 0.2;
  constexpr std::array<double, 6> expected{1.6, 0.7, 0.7, 0.7, 0.7, 2.3};
  for (const auto& [effect, column] : columns)
    normal(column, column) = std::pow(scatter / expected.at(effect.first), 2);
  for (const auto& [key, known] : known_) {
    const double count = static_cast<double>(known.seconds.size());
    const double excess = std::log(std::max(known.mean(), 1e-9)) - base(known.kind);
    const auto effects = effects_of(known.kind);
    for (const Effect& a : effects) {
      right(columns.at(a)) += count * excess;
      for (const Effect& b : effects) normal(columns.at(a), columns.at(b)) += count;
    }
  }
  const Eigen::VectorXd solution = normal.ldlt().solve(right);
  effects_.clear();
  for (const auto& [effect, column] : columns) effects_[effect] = solution(column);
}

double SolveCosts::expected(const SolveKind& kind) const {
  const auto known = known_.find(kind.key());
  if (known != known_.end()) return known->second.at(kind.record);
  fit();
  double logarithm = base(kind);
  for (const Effect& effect : effects_of(kind)) {
    const auto found = effects_.find(effect);
    if (found != effects_.end()) logarithm += found->second;
  }
  return std::exp(logarithm);
}

double SolveCosts::seconds_to_come() const {
  double seconds = 0.0;
  for (const auto& [key, open] : open_) {
    SolveKind kind = open.first;
    for (const std::size_t record : open.second) {
      kind.record = record;
      seconds += expected(kind);
    }
  }
  return seconds;
}

}  // namespace smoothfem
