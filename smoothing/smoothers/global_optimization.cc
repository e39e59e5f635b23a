#include <Eigen/LU>
#include <cmath>
#include <optional>

#include "smoothing/loop/catalogue.h"
#include "smoothing/smoothers/shape_objective.h"

namespace smoothfem {
namespace {

using Vector = ShapeObjective::Vector;

double dot(const Vector& a, const Vector& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

/// Feasible Newton method for the shape objective: block-preconditioned conjugate gradients for the
/// Newton step, ended early far from the minimum or where the curvature is negative, and
/// backtracking that keeps every element valid (the objective is infinite elsewhere) and lowers the
/// objective. The step of an iteration is one Newton step. Source: thesis, Section 1.3.3; Munson,
/// Mesh shape-quality optimization using the inverse mean-ratio metric, Math. Program. 110 (2007).
class GlobalOptimization final : public Smoother<2> {
 public:
  std::string_view name() const override { return "global-optimization"; }

  Parameters parameters() override {
    return {
        {"tolerance",
         "stop when the Newton model promises to lower the objective by no more than this share",
         &tolerance_, 0.0, 1.0},
        {"forcing", "the linear solve leaves at most this share of the gradient", &forcing_, 1e-12,
         0.999},
        {"max_cg_iterations", "at most this many CG iterations a Newton step", &max_cg_iterations_,
         1.0, 1e9},
        {"max_iterations", "stop after this many Newton steps at the latest", &max_iterations_, 1.0,
         1e9}};
  }

  SmoothingRule rule() const override {
    return {.quality_use = QualityUse::none,
            .result = ResultMesh::last,
            .criterion = StoppingCriterion::converged,
            .max_iterations = max_iterations_};
  }

  void initialize(const SmoothingState<2>& state) override {
    objective_.emplace(state.mesh.shared_topology());
    hessian_ = objective_->make_hessian();
    for (Vector* v : {&gradient_, &step_, &residual_, &preconditioned_, &direction_, &product_})
      v->assign(objective_->n_unknown_nodes(), Point<2>::Zero());
    inverse_diagonal_.resize(objective_->n_unknown_nodes());
    trial_ = state.mesh.coordinates();
    value_ = objective_->value(trial_);
    initial_gradient_ = 0.0;
  }

  StepReport step(SmoothingState<2>& state) override {
    auto& x = state.mesh.coordinates();
    objective_->derivatives(x, gradient_, hessian_);
    prepare_preconditioner();
    solve_newton_system();
    const double slope = dot(gradient_, step_);
    const bool moved = line_search(state.mesh, slope);
    return {.converged = !moved || -slope <= tolerance_ * value_};
  }

 private:
  void prepare_preconditioner() {
    for (std::uint32_t i = 0; i < hessian_.n_rows(); ++i)
      inverse_diagonal_[i] = hessian_.block(hessian_.position(i, i)).inverse();
  }
  void precondition(const Vector& r, Vector& z) const {
    for (std::size_t i = 0; i < r.size(); ++i) z[i].noalias() = inverse_diagonal_[i] * r[i];
  }

  /// Preconditioned CG for H step = -gradient. Each element's objective is convex in one node's
  /// place, so the diagonal blocks are positive definite; H itself need not be.
  void solve_newton_system() {
    std::fill(step_.begin(), step_.end(), Point<2>::Zero());
    for (std::size_t i = 0; i < gradient_.size(); ++i) residual_[i] = -gradient_[i];
    precondition(residual_, preconditioned_);
    direction_ = preconditioned_;
    double rho = dot(residual_, preconditioned_);
    const double start = std::sqrt(rho);
    initial_gradient_ = std::max(initial_gradient_, start);
    // Tighter as the minimum comes near, so that the last steps are Newton's own.
    const double goal = start * std::min(forcing_, std::sqrt(start / initial_gradient_));
    for (int k = 0; k < max_cg_iterations_ && std::sqrt(rho) > goal; ++k) {
      hessian_.multiply(direction_, product_);
      const double curvature = dot(direction_, product_);
      if (!(curvature > 0.0)) {
        if (k == 0) step_ = direction_;
        return;
      }
      const double alpha = rho / curvature;
      for (std::size_t i = 0; i < step_.size(); ++i) {
        step_[i] += alpha * direction_[i];
        residual_[i] -= alpha * product_[i];
      }
      precondition(residual_, preconditioned_);
      const double rho_new = dot(residual_, preconditioned_);
      const double beta = rho_new / rho;
      rho = rho_new;
      for (std::size_t i = 0; i < step_.size(); ++i)
        direction_[i] = preconditioned_[i] + beta * direction_[i];
    }
  }

  /// Halves the step until the objective falls enough (Armijo); false if it never does.
  bool line_search(PlanarMesh& mesh, double slope) {
    constexpr double sufficient = 1e-4;
    constexpr int max_halvings = 60;
    auto& x = mesh.coordinates();
    const auto& free_nodes = mesh.topology().free_nodes();
    double alpha = 1.0;
    for (int k = 0; k < max_halvings; ++k, alpha *= 0.5) {
      for (std::size_t i = 0; i < free_nodes.size(); ++i)
        trial_[free_nodes[i]] = x[free_nodes[i]] + alpha * step_[i];
      const double value = objective_->value(trial_);
      if (value <= value_ + sufficient * alpha * slope) {
        x.swap(trial_);
        value_ = value;
        return true;
      }
    }
    return false;
  }

  double tolerance_ = 1e-8;
  double forcing_ = 0.1;
  int max_cg_iterations_ = 1000;
  int max_iterations_ = 1000;

  std::optional<ShapeObjective> objective_;
  BlockMatrix<2> hessian_;
  std::vector<BlockMatrix<2>::Block> inverse_diagonal_;
  Vector gradient_, step_, residual_, preconditioned_, direction_, product_;
  std::vector<Point<2>> trial_;
  double value_ = 0.0;
  double initial_gradient_ = 0.0;
};

const RegisteredMethod registered(
    {.name = "global-optimization",
     .title = "Global Optimization",
     .description = "minimizes the sum of squared mean inverse corner mean ratios by a feasible "
                    "Newton method",
     .source = "Section 1.3.3; Munson (2007)"},
    single_stage<GlobalOptimization>);

}  // namespace
}  // namespace smoothfem
