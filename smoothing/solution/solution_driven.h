// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "smoothing/loop/smoother.h"
#include "smoothing/solution/error_indicators.h"
#include "smoothing/solution/movable_nodes.h"

namespace smoothfem {

/// Base of solution-adaptive methods: they move nodes by the solution, solve again, and so on. The
/// result is the mesh of the lowest energy, and with it of the lowest true error. If boundary nodes
/// slide, energies cannot be compared (their boundary values change); the total of the recovery's
/// error estimates replaces them. Without an energy the result is the last mesh: an estimate may
/// rise as a front is resolved, while the error falls.
template <int dim>
class SolutionDriven : public Smoother<dim> {
 public:
  SmootherTraits traits() const override {
    return {.quality_use = QualityUse::smoother, .result = ResultMesh::best_score};
  }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::step_says_so};
  }

  void initialize(const SmoothingState<dim>& state) override {
    nodes_ = MovableNodes<dim>(state.mesh, boundary_ == slide);
    is_done_ = nodes_.nodes().empty();
    if (is_done_) return;
    n_solves_before_ = state.solver->effort().n_solves;
    state.solver->prepare(state.mesh, degree_);
    prepare(state);
    solve(state);
    is_done_ = !std::isfinite(score_);
  }
  double initial_score() const override { return score_; }

  StepReport step(SmoothingState<dim>& state) override {
    StepReport report;
    is_done_ = is_done_ || n_solves(state) >= n_solves_;
    if (!is_done_) {
      lowest_quality_ = std::min(
          quality_floor_, *std::min_element(state.cell_quality.begin(), state.cell_quality.end()));
      report.n_reset = move_nodes(state);
      solve(state);
      is_done_ = !std::isfinite(score_) || n_solves(state) >= n_solves_ || !has_more_to_try();
    }
    report.score = score_;
    report.quality = mesh_quality(state.mesh.topology(), state.cell_quality);
    report.converged = is_done_;
    return report;
  }

 protected:
  explicit SolutionDriven(double quality_floor) : quality_floor_(quality_floor) {}

  Parameters common_parameters() {
    return {
        {"degree", "degree of the finite elements whose error is reduced", &degree_, 1.0, 2.0},
        {"solves", "largest number of solves of the problem, including the one on the initial mesh",
         &n_solves_, 1.0, 1e6},
        {"boundary",
         "slide: nodes of straight lines and plane faces of the boundary move along them; or stay",
         Choice{&boundary_, {"fixed", "slide"}}},
        {"quality_floor",
         "mean ratio below which nodes of cells are reset; the lowest of the present mesh "
         "if that is lower",
         &quality_floor_, 0.0, 1.0}};
  }

  /// Called before the first solve; for data that depend on the initial mesh of the method.
  virtual void prepare(const SmoothingState<dim>& /*state*/) {}

  /// Moves nodes by the present solution and resets those of cells below lowest_quality(). Returns
  /// the number of reset nodes. Leaves state.cell_quality up to date.
  virtual std::size_t move_nodes(SmoothingState<dim>& state) = 0;

  /// Returns false to end the stage before its solves are used up.
  virtual bool has_more_to_try() const { return true; }

  const MovableNodes<dim>& nodes() const { return nodes_; }
  double lowest_quality() const { return lowest_quality_; }

  /// Returns the recovery's error estimate for the last solve.
  static double estimated_error(const SmoothingState<dim>& state) {
    return std::sqrt(estimated_squared_error(state.mesh, *state.solver));
  }

 private:
  enum Boundary { fixed, slide };

  int n_solves(const SmoothingState<dim>& state) const {
    return static_cast<int>(state.solver->effort().n_solves - n_solves_before_);
  }

  void solve(const SmoothingState<dim>& state) {
    score_ = -state.solver->solve(state.mesh.coordinates());
    if (!state.solver->has_energy())
      score_ = n_solves(state);
    else if (boundary_ == slide && std::isfinite(score_))
      score_ = -estimated_error(state);
  }

  int degree_ = 1;
  int n_solves_ = 10;
  int boundary_ = fixed;
  double quality_floor_;

  MovableNodes<dim> nodes_;
  std::size_t n_solves_before_ = 0;
  double score_ = 0.0, lowest_quality_ = 0.0;
  bool is_done_ = false;
};

}  // namespace smoothfem
