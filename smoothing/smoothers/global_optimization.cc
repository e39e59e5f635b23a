// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <optional>

#include "smoothing/loop/catalogue.h"
#include "smoothing/optimization/block_conjugate_gradients.h"
#include "smoothing/optimization/feasible_movement.h"
#include "smoothing/optimization/shape_objective.h"
#include "smoothing/optimization/vertex_descent.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {
namespace {

/// Feasible Newton method for the shape objective. Each iteration is one Newton step with three
/// parts. First, block-preconditioned conjugate gradients solve the linear system, with an accuracy
/// that follows the progress. Second, the movement of each node is shortened so that its elements
/// stay valid; one blocked node does not stop the others. Third, backtracking continues until the
/// objective, infinite for invalid meshes, has fallen enough.
///
/// Far from the minimum the Hessian is indefinite, and a Newton step does little for elements that
/// have almost collapsed. There the convex model replaces it. Sources: thesis, Section 1.3.3;
/// Munson, Mesh shape-quality optimization using the inverse mean-ratio metric, Math. Program. 110
/// (2007); forcing terms: Eisenstat and Walker, SIAM J. Sci. Comput. 17 (1996).
template <int dim>
class GlobalOptimization final : public Smoother<dim> {
 public:
  std::string_view name() const override { return "global-optimization"; }

  Parameters parameters() override {
    return {
        {"tolerance",
         "stop when a Newton step's model predicts that the objective falls by no more than this "
         "fraction",
         &tolerance_, 0.0, 1.0},
        {"stall",
         "stop when the objective has fallen by less than this fraction in the last 10 steps; not "
         "in the thesis. On graded meshes the last steps are many, long, and change nothing that "
         "matters",
         &stall_, 0.0, 1.0},
        {"newton_below",
         "use the exact Hessian once a step lowers the objective by less than this fraction",
         &newton_below_, 0.0, 1.0},
        {"forcing", "residual of the linear solve, as a fraction of the gradient, at most",
         &forcing_, 1e-12, 0.999},
        {"determinant_fraction",
         "largest fraction of the determinant of an element's corner that a step may remove",
         &determinant_fraction_, 1e-3, 0.999},
        {"max_cg_iterations", "largest number of CG iterations in a Newton step",
         &max_cg_iterations_, 1.0, 1e9},
        {"size_weight",
         "weight of the cells' sizes relative to their shapes, if cells have targets",
         &size_weight_, 0.0, 1e6},
        {"start_sweeps",
         "sweeps of one-node Newton steps before the first Newton step of all nodes; on heavily "
         "distorted meshes 10 sweeps give the shortest run",
         &start_sweeps_, 0.0, 1e9},
        {"max_iterations", "largest number of Newton steps", &max_iterations_, 1.0, 1e9},
        {"result",
         "resulting mesh: the last one, which has the lowest objective, or the one with the "
         "highest q_mean (Section 5.2)",
         Choice{&result_, {"last", "best-q-mean"}}}};
  }

  SmootherTraits traits() const override {
    const bool best = result_ != 0;  // the method itself uses no mean ratio
    return {.quality_use = best ? QualityUse::loop : QualityUse::none,
            .result = best ? ResultMesh::best_q_mean : ResultMesh::last,
            .takes_targets = true};
  }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::step_says_so, .max_iterations = max_iterations_};
  }

  void initialize(const SmoothingState<dim>& state) override {
    if (start_sweeps_ > 0 && state.mesh.targets())
      throw InputError(
          "method global-optimization: start_sweeps cannot be used with targets; set it to 0");
    objective_.emplace(state.mesh.shared_topology(), state.mesh.shared_targets(), size_weight_);
    hessian_ = objective_->make_hessian();
    gradient_ = right_ = step_ = hessian_.make_vector();
    trial_.assign(state.mesh.coordinates().begin(), state.mesh.coordinates().end());
    start_ = start_sweeps_ > 0;
    value_ = objective_->value(trial_);
    model_ = HessianModel::convex;
    gradient_norm_ = 0.0;
    values_.assign(1, value_);
  }

  StepReport step(SmoothingState<dim>& state) override {
    if (start_) sweep_nodes(state.mesh);
    const double value_before = value_;
    const bool exact = find_newton_step(state.mesh);
    double slope = limit_step(state.mesh);
    if (!(slope < 0.0)) {
      // Shortened node by node, this is a descent direction even if the Newton step was not.
      solver_.precondition(right_, step_);
      slope = limit_step(state.mesh);
    }
    const bool moved = line_search(state.mesh, slope);
    const bool near = !moved || value_before - value_ < newton_below_ * value_before;
    model_ = near ? HessianModel::exact : HessianModel::convex;
    return {.converged =
                (exact && (!moved || -slope <= tolerance_ * value_before)) || has_stalled()};
  }

 private:
  void sweep_nodes(Mesh<dim>& mesh) {
    start_ = false;
    const VertexDescent<dim> descent(mesh.topology());
    for (int i = 0; i < start_sweeps_; ++i) descent.sweep(mesh.coordinates());
    trial_.assign(mesh.coordinates().begin(), mesh.coordinates().end());
    value_ = objective_->value(trial_);
  }

  /// True if the last steps together have lowered the objective too little.
  bool has_stalled() {
    values_.push_back(value_);
    if (values_.size() <= n_stall_steps) return false;
    const double before = values_[values_.size() - 1 - n_stall_steps];
    return before - value_ < stall_ * before;
  }

  /// Solves with the present model; if that is the exact Hessian and it is indefinite, solves with
  /// the convex model. Returns true if the Hessian was exact or had to be replaced.
  bool find_newton_step(const Mesh<dim>& mesh) {
    if (model_ == HessianModel::convex) {
      solve(mesh);
      return false;
    }
    if (solve(mesh).negative_curvature) {
      model_ = HessianModel::convex;
      solve(mesh);
    }
    return true;
  }

  typename BlockConjugateGradients<dim>::Result solve(const Mesh<dim>& mesh) {
    objective_->derivatives(mesh.coordinates(), model_, gradient_, hessian_);
    for (std::size_t i = 0; i < gradient_.size(); ++i) right_[i] = -gradient_[i];
    solver_.prepare(hessian_);
    // Tighter when the gradient falls faster, so that the last steps are exact Newton steps.
    const double norm = solver_.norm(right_);
    const double fall = gradient_norm_ > 0.0 ? norm / gradient_norm_ : 1.0;
    gradient_norm_ = norm;
    const double tolerance = std::min(forcing_, 0.9 * fall * std::sqrt(fall));
    return solver_.solve(right_, tolerance, max_cg_iterations_, step_);
  }

  void set_trial(const Mesh<dim>& mesh, double alpha) {
    const auto& free_nodes = mesh.topology().free_nodes();
    for (std::size_t i = 0; i < free_nodes.size(); ++i)
      trial_[free_nodes[i]] = mesh.coordinates()[free_nodes[i]] + alpha * step_[i];
  }

  /// Shortens the step of each node so that its elements keep positive determinants, in a few
  /// rounds; the line search handles the rest. Returns the slope along the step.
  double limit_step(const Mesh<dim>& mesh) {
    constexpr int max_rounds = 5;
    const auto& free_nodes = mesh.topology().free_nodes();
    for (int round = 0; round < max_rounds; ++round) {
      set_trial(mesh, 1.0);
      if (feasible_fractions<dim>(mesh.topology(), mesh.coordinates(), trial_,
                                  determinant_fraction_, limits_) == 1.0)
        break;
      for (std::size_t i = 0; i < free_nodes.size(); ++i) step_[i] *= limits_[free_nodes[i]];
    }
    if (mesh.targets()) keep_sizes(mesh);
    return dot<dim>(gradient_, step_);
  }

  /// Halves the steps of nodes whose cells would get sizes beyond the targets' bound, in the end to
  /// zero.
  void keep_sizes(const Mesh<dim>& mesh) {
    constexpr int max_halvings = 8;
    const auto& free_nodes = mesh.topology().free_nodes();
    Mesh<dim> trial = mesh;
    std::vector<double> quality;
    for (int k = 0; k <= max_halvings; ++k) {
      set_trial(mesh, 1.0);
      trial.set_coordinates(trial_);
      if (compute_cell_mean_ratios(trial, quality).n_invalid == 0) return;
      limits_.assign(mesh.n_nodes(), 1.0);
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        if (!(quality[c] > 0.0))
          for (const NodeIndex i : mesh.topology().cell_nodes(c))
            limits_[i] = k < max_halvings ? 0.5 : 0.0;
      for (std::size_t i = 0; i < free_nodes.size(); ++i) step_[i] *= limits_[free_nodes[i]];
    }
  }

  /// Halves the step until the objective falls enough (Armijo). Returns false if it never does.
  bool line_search(Mesh<dim>& mesh, double slope) {
    constexpr double sufficient = 1e-4;
    constexpr int max_halvings = 60;
    double alpha = 1.0;
    for (int k = 0; k < max_halvings; ++k, alpha *= 0.5) {
      set_trial(mesh, alpha);
      const double value = objective_->value(trial_);
      if (value <= value_ + sufficient * alpha * slope) {
        mesh.swap_coordinates(trial_);
        value_ = value;
        return true;
      }
    }
    return false;
  }

  static constexpr std::size_t n_stall_steps = 10;

  double tolerance_ = 1e-8;
  double stall_ = 1e-4;
  double newton_below_ = 1e-3;
  double forcing_ = 0.3;
  double determinant_fraction_ = 0.9;
  double size_weight_ = 30.0;
  int max_cg_iterations_ = 1000;
  int start_sweeps_ = 0;
  int max_iterations_ = 1000;
  int result_ = 0;

  std::optional<ShapeObjective<dim>> objective_;
  HessianModel model_ = HessianModel::convex;
  BlockMatrix<dim> hessian_;
  BlockConjugateGradients<dim> solver_;
  BlockVector<dim> gradient_, right_, step_;
  std::vector<Point<dim>> trial_;
  std::vector<double> limits_;
  double value_ = 0.0;
  std::vector<double> values_;  ///< after each step
  double gradient_norm_ = 0.0;
  bool start_ = false;  ///< true if the next step begins with the sweeps
};

const RegisteredMethod registered(
    {.name = "global-optimization",
     .title = "Global Optimization",
     .description = "minimizes the sum of squared mean inverse corner mean ratios by a feasible "
                    "Newton method",
     .source = "Section 1.3.3; Munson (2007)"},
    single_stage<GlobalOptimization>());

}  // namespace
}  // namespace smoothfem
