// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "smoothing/loop/smoother.h"

namespace smoothfem {

/// History of a stage's iterations, for its stopping rule.
class StageHistory {
 public:
  explicit StageHistory(const MeshQuality& initial);

  /// Adds an iteration that led to this quality. is_best: true if it reached the best mesh so far.
  void add(const MeshQuality& quality, bool is_best);

  /// Returns why the stage ends after this iteration, or nothing if it continues.
  std::optional<std::string> why_stop(const StoppingRule& rule, const StepReport& report,
                                      double initial_q_star_min, double mean_edge_length);

 private:
  std::string below_start_text(const StoppingRule& rule, int patience) const;

  MeshQuality present_;
  double q_min_, q_star_min_, q_mean_;  ///< the highest ones so far
  double q_mean_gain_ = 0.0;            ///< of the last iteration
  int n_without_gain_ = 0, n_without_best_ = 0;
  bool exceeded_patience_ = false;  ///< past the patience, while below the start
};

}  // namespace smoothfem
