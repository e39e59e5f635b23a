// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/loop/parameter.h"

namespace smoothfem {

/// Rule that ends a stage of a method.
struct StoppingRule {
  enum class Criterion {
    q_mean_gain,  ///< q_mean rose by no more than `tolerance` in an iteration
    /// q_mean changed by no more than `tolerance`, or `patience` iterations in a row without a new
    /// highest q_min or q_mean
    q_mean_change,
    max_displacement,  ///< no node moved `tolerance` times the initial mean edge length
    /// `patience` iterations in a row without a new best mesh (ResultMesh), or the step reports
    /// convergence. While q*_min is below that of the start, more iterations are allowed
    /// (patience_below_start).
    result_stall,
    step_says_so,  ///< StepReport::converged
  };
  Criterion criterion;
  double tolerance = 0.0;
  int patience = 0;
  /// Factor on the patience while the best q*_min is below that of the initial mesh of the method.
  /// Applies to stages that raise q*_min. Not in the thesis: an earlier stage may have lowered
  /// q*_min, and the result should not be worse than the start.
  int patience_below_start = 1;
  int max_iterations = 10000;  ///< limit for methods that would never stop

  /// Returns the number of iterations without a gain that ends the stage.
  int patience_at(double best_q_star_min, double initial_q_star_min) const {
    return best_q_star_min < initial_q_star_min ? patience_below_start * patience : patience;
  }
};

/// Stopping parameters of methods that end when q_mean hardly changes any more. They keep the mesh
/// with the best q_mean, which need not be the last.
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
             "0, or continue after iterations that lower q_mean, until this many in a row raise "
             "neither the best q_min nor the best q_mean (Section 5.2: 50)",
             &patience, 0.0, 1e9},
            {"max_iterations", "largest number of iterations", &max_iterations, 1.0, 1e9}};
  }
  StoppingRule rule() const {
    using enum StoppingRule::Criterion;
    return {.criterion = patience > 0 ? q_mean_change : q_mean_gain,
            .tolerance = tolerance,
            .patience = patience,
            .max_iterations = max_iterations};
  }
};

/// Stopping parameters of the Laplacian methods without quality control (thesis, Section 1.3.2).
/// They end when no node moves farther than a fraction of the mean edge length of the initial mesh.
struct DisplacementStopping {
  double tolerance = 0.01;  ///< the thesis' 1 %
  int max_iterations = 10000;

  Parameters parameters() {
    return {{"tolerance",
             "stop when the longest node movement falls below this fraction of the initial mean "
             "edge length (Section 1.3.2)",
             &tolerance, 0.0, 1e3},
            {"max_iterations", "largest number of iterations", &max_iterations, 1.0, 1e9}};
  }
  StoppingRule rule() const {
    return {.criterion = StoppingRule::Criterion::max_displacement,
            .tolerance = tolerance,
            .max_iterations = max_iterations};
  }
};

}  // namespace smoothfem
