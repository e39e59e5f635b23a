// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/laplacian/laplacian_sweep.h"

namespace smoothfem {

/// Stopping parameters of Laplacian methods without quality control, and the result that belongs to
/// them. Default: the longest movement ends the method, and its last mesh is the result (thesis,
/// Section 1.3.2). In Section 5.4 the mean quality ends other methods, and the mesh with the best
/// mean quality is the result, also if it has invalid cells.
class SweepStopping {
 public:
  Parameters parameters() {
    Parameters all = by_movement_.parameters();
    all.push_back({"stop_by",
                   "what ends the method: the longest movement, with the last mesh as the result "
                   "(Section 1.3.2), or q_mean, with the mesh of the best q_mean (Section 5.4)",
                   Choice{&stop_by_, {"movement", "q-mean"}}});
    all.push_back({"q_mean_tolerance",
                   "with q-mean: stop when q_mean changes by no more than this in an iteration",
                   &q_mean_tolerance_, 0.0, 1.0});
    all.push_back({"q_mean_patience",
                   "with q-mean: stop after this many iterations in a row that raise neither the "
                   "best q_min nor the best q_mean",
                   &q_mean_patience_, 1.0, 1e9});
    return all;
  }

  SmootherTraits traits() const {
    SmootherTraits traits = uncontrolled_sweeps;
    if (stop_by_ == q_mean) traits.result = ResultMesh::best_q_mean;
    return traits;
  }

  StoppingRule rule() const {
    if (stop_by_ == movement) return by_movement_.rule();
    return {.criterion = StoppingRule::Criterion::q_mean_change,
            .tolerance = q_mean_tolerance_,
            .patience = q_mean_patience_,
            .max_iterations = by_movement_.max_iterations};
  }

 private:
  enum StopBy { movement, q_mean };

  DisplacementStopping by_movement_;
  int stop_by_ = movement;
  double q_mean_tolerance_ = 1e-6;  ///< Section 5.4
  int q_mean_patience_ = 50;        ///< Section 5.2
};

}  // namespace smoothfem
