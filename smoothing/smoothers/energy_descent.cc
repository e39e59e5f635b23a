// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/invalid_node_reset.h"
#include "smoothing/solution/node_descent.h"
#include "smoothing/solution/start_method.h"

namespace smoothfem {
namespace {

/// Moves nodes to lower the energy J of the solution u_h. With fixed boundary nodes |grad(u -
/// u_h)|^2 = J + const, so that the true error falls although u is unknown. Each iteration solves
/// once, on a mesh that is kept if J is lower there. Boundary nodes stay, even if an earlier stage
/// has let them slide.
template <int dim>
class EnergyDescent final : public Smoother<dim> {
 public:
  explicit EnergyDescent(int n_pairs) : n_pairs_(n_pairs) {}

  std::string_view name() const override { return "descent"; }
  Parameters parameters() override {
    return {
        {"degree", "degree of the finite elements whose error is reduced", &degree_, 1.0, 2.0},
        {"solves", "largest number of solves of the problem, including the one on the initial mesh",
         &n_solves_, 1.0, 1e6},
        {"memory", "pairs of steps and changes of the gradient for L-BFGS; 0: descent along L^-1 g",
         &n_pairs_, 0.0, 1e3},
        {"quality_floor",
         "mean ratio below which nodes of cells are reset; the lowest of the present mesh "
         "if that is lower",
         &quality_floor_, 0.0, 1.0},
        {"gain",
         "stop when a solve lowers the energy by less than this fraction of all earlier "
         "reductions together; 0: continue until 'solves'",
         &min_gain_, 0.0, 1.0}};
  }
  SmootherTraits traits() const override {
    return {.quality_use = QualityUse::smoother, .result = ResultMesh::last};
  }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::step_says_so};
  }

  void initialize(const SmoothingState<dim>& state) override {
    nodes_ = MovableNodes<dim>(state.mesh, false);
    is_done_ = nodes_.nodes().empty();
    if (is_done_) return;
    descent_ = std::make_unique<NodeDescent<dim>>(state.mesh.topology(), nodes_, n_pairs_);
    n_solves_before_ = state.solver->effort().n_solves;
    state.solver->prepare(state.mesh, degree_);
    energy_ = first_energy_ = state.solver->solve(state.mesh.coordinates());
    base_ = state.mesh.copied_coordinates();
    has_direction_ = false;
    is_done_ = !std::isfinite(energy_);
  }

  StepReport step(SmoothingState<dim>& state) override {
    StepReport report;
    // Without an earlier solve, the solve on the initial mesh uses up the budget.
    is_done_ = is_done_ || n_solves(state) >= n_solves_;
    if (!is_done_) {
      if (!has_direction_) choose_direction(state);
      report.n_reset = move_nodes(state);
      const double energy = state.solver->solve(state.mesh.coordinates());
      if (energy < energy_)
        accept(state, energy);
      else
        reject(state);
      is_done_ = is_done_ || n_solves(state) >= n_solves_ || descent_->is_stuck();
    }
    report.quality = mesh_quality(state.mesh.topology(), state.cell_quality);
    report.converged = is_done_;
    return report;
  }

 private:
  int n_solves(const SmoothingState<dim>& state) const {
    return static_cast<int>(state.solver->effort().n_solves - n_solves_before_);
  }

  void choose_direction(const SmoothingState<dim>& state) {
    descent_->choose_direction(state.mesh, state.solver->energy_gradient());
    lowest_quality_ = std::min(
        quality_floor_, *std::min_element(state.cell_quality.begin(), state.cell_quality.end()));
    has_direction_ = true;
  }

  /// Returns the number of nodes that were reset.
  std::size_t move_nodes(SmoothingState<dim>& state) {
    descent_->move_from(base_, state.mesh);
    compute_cell_mean_ratios(state.mesh, state.cell_quality);
    return reset_nodes_of_invalid_cells(state.mesh, base_, state.cell_quality, lowest_quality_)
        .size();
  }

  void accept(const SmoothingState<dim>& state, double energy) {
    const double gain = energy_ - energy, gain_before = first_energy_ - energy_;
    is_done_ = gain_before > 0.0 && gain < min_gain_ * gain_before;
    descent_->accept(base_, state.mesh);
    energy_ = energy;
    base_ = state.mesh.copied_coordinates();
    has_direction_ = false;
  }

  void reject(SmoothingState<dim>& state) {
    state.mesh.set_coordinates(base_);
    compute_cell_mean_ratios(state.mesh, state.cell_quality);
    descent_->reject();
  }

  int degree_ = 1;
  int n_solves_ = 10;
  int n_pairs_;
  double quality_floor_ = 0.3;
  double min_gain_ = 0.0;

  MovableNodes<dim> nodes_;
  std::unique_ptr<NodeDescent<dim>> descent_;
  std::size_t n_solves_before_ = 0;
  double energy_ = 0.0, first_energy_ = 0.0;
  double lowest_quality_ = 0.0;
  std::vector<Point<dim>> base_;  ///< the mesh of the lowest energy so far
  bool has_direction_ = false, is_done_ = false;
};

template <int dim, int n_pairs>
Stages<dim> make_stages() {
  Stages<dim> stages;
  stages.push_back(std::make_unique<StartMethod<dim>>());
  stages.push_back(std::make_unique<EnergyDescent<dim>>(n_pairs));
  return stages;
}

const RegisteredMethod descent({.name = "energy-descent",
                                .title = "Energy descent",
                                .description = "GETMe, then nodes move to lower the energy of the "
                                               "solution, and with it the true error; one solve "
                                               "in each iteration",
                                .source = "Delfour, Payre, Zolésio 1985; Sobolev gradient",
                                .problem_use = {.energy_gradient = true}},
                               {make_stages<2, 0>, make_stages<3, 0>});
const RegisteredMethod lbfgs({.name = "energy-lbfgs",
                              .title = "Energy L-BFGS",
                              .description = "energy-descent by limited-memory BFGS",
                              .source = "Nocedal 1980",
                              .problem_use = {.energy_gradient = true}},
                             {make_stages<2, 10>, make_stages<3, 10>});

}  // namespace
}  // namespace smoothfem
