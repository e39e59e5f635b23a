// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "smoothing/loop/catalogue.h"
#include "smoothing/optimization/feasible_newton.h"
#include "smoothing/second_order/curved_objective.h"

namespace smoothfem {
namespace {

/// Minimizes the sum over cells of the mean of f^2 over the ideal cell and of the weighted bending,
/// with the inverse mean ratio f of the cell's mapping (curved_objective.h), over corners and
/// midside nodes, by the feasible Newton method (feasible_newton.h). The sum is infinite where a
/// curved cell is not proven valid.
template <int dim>
class CurvedOptimization final : public Smoother<dim> {
 public:
  std::string_view name() const override { return "curved-optimization"; }

  Parameters parameters() override {
    Parameters all = newton_parameters_.list("a cell's mapping at a point");
    all.push_back({"straightness",
                   "weight of the bending of cells; 0: angles alone count, and edges inside bend",
                   &straightness_, 0.0, 1e9});
    all.push_back({"max_iterations", "largest number of Newton steps", &max_iterations_, 1.0, 1e9});
    return all;
  }

  SmootherTraits traits() const override {
    return {
        .quality_use = QualityUse::none, .result = ResultMesh::last, .moves_midside_nodes = true};
  }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::step_says_so, .max_iterations = max_iterations_};
  }

  void initialize(const SmoothingState<dim>& state) override {
    objective_.emplace(state.mesh.shared_topology(), straightness_);
    newton_.emplace(*objective_, newton_parameters_, state.mesh.coordinates());
  }

  StepReport step(SmoothingState<dim>& state) override {
    return {.converged = newton_->step(
                state.mesh, [&](auto& newton, const Mesh<dim>& mesh) { limit(newton, mesh); })};
  }

 private:
  using Newton = FeasibleNewton<dim, CurvedObjective<dim>>;

  /// Shortens the step of each node so that its cells stay valid, in a few rounds; the line search
  /// handles the rest.
  void limit(Newton& newton, const Mesh<dim>& mesh) const {
    constexpr int max_rounds = 5;
    newton.shorten(mesh, max_rounds, [&](int, const auto& to, std::vector<double>& limits) {
      return objective_->limits(mesh.coordinates(), to, newton_parameters_.determinant_fraction,
                                limits) != 1.0;
    });
  }

  NewtonParameters newton_parameters_;
  double straightness_ = 100.0;
  int max_iterations_ = 1000;

  std::optional<CurvedObjective<dim>> objective_;
  std::optional<Newton> newton_;
};

const RegisteredMethod registered(
    {.name = "curved-optimization",
     .title = "Curved Optimization",
     .description =
         "minimizes the integral of squared inverse mean ratios over curved cells and "
         "their bending by a feasible Newton method that moves corners and midside nodes",
     .source = "Gargallo-Peiro et al. (2015); Knupp (2012); Dobrev et al. (2019)"},
    single_stage<CurvedOptimization>());

}  // namespace
}  // namespace smoothfem
