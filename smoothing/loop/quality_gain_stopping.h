#pragma once

#include "smoothing/loop/smoother.h"

namespace smoothfem {

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
  SmoothingRule rule() const {
    return {.quality_use = QualityUse::loop,
            .result = ResultMesh::best_q_mean,
            .criterion =
                patience > 0 ? StoppingCriterion::q_mean_change : StoppingCriterion::q_mean_gain,
            .tolerance = tolerance,
            .patience = patience,
            .max_iterations = max_iterations};
  }
};

}  // namespace smoothfem
