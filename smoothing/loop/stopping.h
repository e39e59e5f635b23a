// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/loop/parameter.h"

namespace smoothfem {

/// When a stage of a method stops.
struct StoppingRule {
  enum class Criterion {
    q_mean_gain,  ///< q_mean rose by no more than `tolerance` in an iteration
    /// q_mean changed by no more than `tolerance`, or `patience` iterations in a row without a new
    /// highest q_min or q_mean
    q_mean_change,
    max_displacement,  ///< no node moved `tolerance` times the initial mean edge length
    /// `patience` iterations in a row without a new best mesh (ResultMesh), more of them while
    /// q*_min is below the start's (patience_below_start); or the step says so
    result_stall,
    step_says_so,  ///< StepReport::converged
  };
  Criterion criterion;
  double tolerance = 0.0;
  int patience = 0;
  /// How many times its patience a stage that raises q*_min goes on for while its best q*_min is
  /// below that of the mesh the method began with. Not in the thesis: an earlier stage may have
  /// lowered q*_min, and the result should not be worse than the start.
  int patience_below_start = 1;
  int max_iterations = 10000;  ///< against methods that would never stop

  /// The iterations without a gain that end the stage.
  int patience_at(double best_q_star_min, double initial_q_star_min) const {
    return best_q_star_min < initial_q_star_min ? patience_below_start * patience : patience;
  }
};

/// The stopping parameters of methods that end when q_mean hardly changes any more; they keep the
/// mesh with the best q_mean, which need not be the last.
struct QualityGainStopping {
  double tolerance = 1e-4;  ///< Section 6.2
  int patience = 0;
  int max_iterations = 10000;

  Parameters parameters() {
    return {{"tolerance",
             "stop when q_mean rises by no more than this in an iteration (Section 6.2); with "
             "patience, when it changes by no more than this",
             &tolerance, -1.0, 1.0},
            {"patience",
             "0, or go on after iterations that lower q_mean, until this many in a row raise "
             "neither the best q_min nor the best q_mean (Section 5.2: 50)",
             &patience, 0.0, 1e9},
            {"max_iterations", "stop after this many iterations at the latest", &max_iterations,
             1.0, 1e9}};
  }
  StoppingRule rule() const {
    using enum StoppingRule::Criterion;
    return {.criterion = patience > 0 ? q_mean_change : q_mean_gain,
            .tolerance = tolerance,
            .patience = patience,
            .max_iterations = max_iterations};
  }
};

/// The stopping parameters of the Laplacian methods without quality control (thesis, 1.3.2): they
/// end when no node moves farther than a fraction of the mean edge length of the initial mesh.
struct DisplacementStopping {
  double tolerance = 0.01;  ///< the thesis' 1 %
  int max_iterations = 10000;

  Parameters parameters() {
    return {{"tolerance",
             "stop when the longest node movement falls below this fraction of the initial mean "
             "edge length (Section 1.3.2)",
             &tolerance, 0.0, 1e3},
            {"max_iterations", "stop after this many iterations at the latest", &max_iterations,
             1.0, 1e9}};
  }
  StoppingRule rule() const {
    return {.criterion = StoppingRule::Criterion::max_displacement,
            .tolerance = tolerance,
            .max_iterations = max_iterations};
  }
};

}  // namespace smoothfem
