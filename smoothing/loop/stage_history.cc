// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/loop/stage_history.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace smoothfem {

namespace {

std::string short_text(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

std::string iterations_text(int n) {
  return n == 1 ? "an iteration" : std::to_string(n) + " iterations";
}

}  // namespace

StageHistory::StageHistory(const MeshQuality& initial)
    : present_(initial),
      q_min_(initial.q_min),
      q_star_min_(initial.q_star_min),
      q_mean_(initial.q_mean) {}

void StageHistory::add(const MeshQuality& quality, bool is_best) {
  n_without_best_ = is_best ? 0 : n_without_best_ + 1;
  const bool gain = quality.q_min > q_min_ || quality.q_mean > q_mean_;
  n_without_gain_ = gain ? 0 : n_without_gain_ + 1;
  q_min_ = std::max(q_min_, quality.q_min);
  q_star_min_ = std::max(q_star_min_, quality.q_star_min);
  q_mean_ = std::max(q_mean_, quality.q_mean);
  q_mean_gain_ = quality.q_mean - present_.q_mean;
  present_ = quality;
}

std::optional<std::string> StageHistory::why_stop(const StoppingRule& rule,
                                                  const StepReport& report,
                                                  double initial_q_star_min,
                                                  double mean_edge_length) {
  using enum StoppingRule::Criterion;
  switch (rule.criterion) {
    case q_mean_gain:
      if (q_mean_gain_ > rule.tolerance) return std::nullopt;
      return "q_mean rose by no more than the tolerance " + short_text(rule.tolerance);
    case q_mean_change:
      if (std::abs(q_mean_gain_) <= rule.tolerance)
        return "q_mean changed by no more than the tolerance " + short_text(rule.tolerance);
      if (n_without_gain_ < rule.patience) return std::nullopt;
      return "no improvement of q_min or q_mean in " + iterations_text(rule.patience);
    case max_displacement:
      if (!(report.max_displacement < rule.tolerance * mean_edge_length)) return std::nullopt;
      return "no node moved farther than " + short_text(rule.tolerance) + " mean edge lengths";
    case result_stall: {
      const int patience = rule.patience_at(q_star_min_, initial_q_star_min);
      if (n_without_best_ >= patience)
        return "no improvement in " + iterations_text(patience) + below_start_text(rule, patience);
      exceeded_patience_ = exceeded_patience_ || n_without_best_ >= rule.patience;
      [[fallthrough]];
    }
    case step_says_so:
      if (!report.converged) return std::nullopt;
      return "it converged";
  }
  return std::nullopt;
}

/// Describes the effect of patience_below_start, an addition to the thesis.
std::string StageHistory::below_start_text(const StoppingRule& rule, int patience) const {
  const std::string origin = " (patience_below_start; not in the thesis)";
  if (patience > rule.patience)
    return ", " + std::to_string(rule.patience_below_start) +
           " times the patience, as q*_min is below that of the start" + origin;
  if (exceeded_patience_)
    return ", after an extended patience while q*_min was below that of the start" + origin;
  return "";
}

}  // namespace smoothfem
