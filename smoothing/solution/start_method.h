// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/smooth.h"

namespace smoothfem {

/// First stage of solution-adaptive methods: runs another method to its end in one iteration. So
/// they begin with cells of good quality and spend their solves on the rest.
template <int dim>
class StartMethod final : public Smoother<dim> {
 public:
  std::string_view name() const override { return "start"; }
  Parameters parameters() override {
    return {{"method",
             "method that smooths the mesh first, with its default parameters; none: no such stage",
             &method_}};
  }
  SmootherTraits traits() const override {
    return {.quality_use = QualityUse::smoother, .result = ResultMesh::last};
  }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::step_says_so};
  }

  void check_parameters() const override {
    if (method_ != "none" && make_method<dim>(method_).info.needs_problem())
      throw InputError(
          "'start.method' is " + method_ +
          ", which is a solution-adaptive method itself; choose another method, or none");
  }

  StepReport step(SmoothingState<dim>& state) override {
    check_parameters();
    if (method_ != "none") {
      auto method = make_method<dim>(method_);
      smooth(state.mesh, method);
    }
    StepReport report{.converged = true};
    report.quality = compute_cell_mean_ratios(state.mesh, state.cell_quality);
    if (report.quality->n_invalid > 0)
      throw SmootherFailure("method " + method_ + " has left " +
                            std::to_string(report.quality->n_invalid) +
                            " invalid cells, on which no problem can be solved");
    return report;
  }

 private:
  std::string method_ = "getme";
};

}  // namespace smoothfem
