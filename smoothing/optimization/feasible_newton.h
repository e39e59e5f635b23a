// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "smoothing/loop/parameter.h"
#include "smoothing/mesh/mesh.h"
#include "smoothing/optimization/block_conjugate_gradients.h"
#include "smoothing/optimization/cell_derivatives.h"

namespace smoothfem {

/// The user's parameters of a feasible Newton method.
struct NewtonParameters {
  double tolerance = 1e-8;
  double stall = 1e-4;
  double newton_below = 1e-3;
  double forcing = 0.3;
  double determinant_fraction = 0.9;
  int max_cg_iterations = 1000;

  Parameters list(const std::string& point_of_element) {
    return {
        {"tolerance",
         "stop when a Newton step's model predicts that the objective falls by no more than this "
         "fraction",
         &tolerance, 0.0, 1.0},
        {"stall",
         "stop when the objective has fallen by less than this fraction in the last 10 steps; not "
         "in the thesis. On graded meshes the last steps are many, long, and change nothing that "
         "matters",
         &stall, 0.0, 1.0},
        {"newton_below",
         "use the exact Hessian once a step lowers the objective by less than this fraction",
         &newton_below, 0.0, 1.0},
        {"forcing", "residual of the linear solve, as a fraction of the gradient, at most",
         &forcing, 1e-12, 0.999},
        {"determinant_fraction",
         "largest fraction of the determinant of " + point_of_element + " that a step may remove",
         &determinant_fraction, 1e-3, 0.999},
        {"max_cg_iterations", "largest number of CG iterations in a Newton step",
         &max_cg_iterations, 1.0, 1e9}};
  }
};

/// Feasible Newton method for an objective that is infinite for invalid meshes. Each iteration is
/// one Newton step with three parts. First, block-preconditioned conjugate gradients solve the
/// linear system, with an accuracy that follows the progress. Second, the movement of each node is
/// shortened so that its elements stay valid; one blocked node does not stop the others. Third,
/// backtracking continues until the objective has fallen enough.
///
/// Far from the minimum the Hessian is indefinite, and a Newton step does little for elements that
/// have almost collapsed. There the convex model replaces it. Sources: thesis, Section 1.3.3;
/// Munson, Mesh shape-quality optimization using the inverse mean-ratio metric, Math. Program. 110
/// (2007); forcing terms: Eisenstat and Walker, SIAM J. Sci. Comput. 17 (1996).
///
/// Objective: a class with unknown_nodes(), value(), make_hessian() and derivatives(), as
/// ShapeObjective has them.
template <int dim, class Objective>
class FeasibleNewton {
 public:
  /// Starts at these coordinates. `objective` and `parameters` live longer than this object.
  FeasibleNewton(Objective& objective, const NewtonParameters& parameters,
                 std::span<const Point<dim>> coordinates)
      : objective_(objective), parameters_(parameters), hessian_(objective.make_hessian()) {
    gradient_ = right_ = step_ = hessian_.make_vector();
    move_to(coordinates);
    values_.assign(1, value_);
  }

  /// Continues at other coordinates.
  void move_to(std::span<const Point<dim>> coordinates) {
    trial_.assign(coordinates.begin(), coordinates.end());
    value_ = objective_.value(trial_);
  }

  double value() const { return value_; }

  /// One iteration; returns true if the method has converged. limit(*this, mesh): shortens the
  /// step by calls of shorten(). Collective in a part of a mesh, as all that it calls.
  template <class Limit>
  bool step(Mesh<dim>& mesh, const Limit& limit) {
    const double value_before = value_;
    const bool exact = find_newton_step(mesh);
    double slope = limited_slope(mesh, limit);
    if (!(slope < 0.0)) {
      // Shortened node by node, this is a descent direction even if the Newton step was not.
      solver_.precondition(right_, step_);
      slope = limited_slope(mesh, limit);
    }
    const bool moved = line_search(mesh, slope);
    const bool near = !moved || value_before - value_ < parameters_.newton_below * value_before;
    model_ = near ? HessianModel::exact : HessianModel::convex;
    return (exact && (!moved || -slope <= parameters_.tolerance * value_before)) || has_stalled();
  }

  /// Shortens the step of each node, in a few rounds. find_limits(round, to, limits): sets
  /// limits[i] in [0, 1] for each node i on its way to the point to[i]; returns false if all of
  /// them are 1.
  template <class FindLimits>
  void shorten(const Mesh<dim>& mesh, int max_rounds, const FindLimits& find_limits) {
    const auto& nodes = objective_.unknown_nodes();
    for (int round = 0; round < max_rounds; ++round) {
      set_trial(mesh, 1.0);
      if (!find_limits(round, std::as_const(trial_), limits_)) return;
      for (std::size_t i = 0; i < nodes.size(); ++i) step_[i] *= limits_[nodes[i]];
      hessian_.rows().update(step_);  // limits of copied nodes are incomplete
    }
  }

 private:
  /// True if the last steps together have lowered the objective too little.
  bool has_stalled() {
    values_.push_back(value_);
    if (values_.size() <= n_stall_steps) return false;
    const double before = values_[values_.size() - 1 - n_stall_steps];
    return before - value_ < parameters_.stall * before;
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
    objective_.derivatives(mesh.coordinates(), model_, gradient_, hessian_);
    for (std::size_t i = 0; i < gradient_.size(); ++i) right_[i] = -gradient_[i];
    solver_.prepare(hessian_);
    // Tighter when the gradient falls faster, so that the last steps are exact Newton steps.
    const double norm = solver_.norm(right_);
    const double fall = gradient_norm_ > 0.0 ? norm / gradient_norm_ : 1.0;
    gradient_norm_ = norm;
    const double tolerance = std::min(parameters_.forcing, 0.9 * fall * std::sqrt(fall));
    return solver_.solve(right_, tolerance, parameters_.max_cg_iterations, step_);
  }

  void set_trial(const Mesh<dim>& mesh, double alpha) {
    const auto& nodes = objective_.unknown_nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      trial_[nodes[i]] = mesh.coordinates()[nodes[i]] + alpha * step_[i];
  }

  template <class Limit>
  double limited_slope(const Mesh<dim>& mesh, const Limit& limit) {
    limit(*this, mesh);
    return hessian_.rows().sum(
        [&](std::size_t i, double& sum) { sum += gradient_[i].dot(step_[i]); });
  }

  /// Halves the step until the objective falls enough (Armijo). Returns false if it never does.
  bool line_search(Mesh<dim>& mesh, double slope) {
    constexpr double sufficient = 1e-4;
    constexpr int max_halvings = 60;
    double alpha = 1.0;
    for (int k = 0; k < max_halvings; ++k, alpha *= 0.5) {
      set_trial(mesh, alpha);
      const double value = objective_.value(trial_);
      if (value <= value_ + sufficient * alpha * slope) {
        mesh.swap_coordinates(trial_);
        value_ = value;
        return true;
      }
    }
    return false;
  }

  static constexpr std::size_t n_stall_steps = 10;

  Objective& objective_;
  const NewtonParameters& parameters_;
  HessianModel model_ = HessianModel::convex;
  BlockMatrix<dim> hessian_;
  BlockConjugateGradients<dim> solver_;
  BlockVector<dim> gradient_, right_, step_;
  std::vector<Point<dim>> trial_;
  std::vector<double> limits_;
  double value_ = 0.0;
  std::vector<double> values_;  ///< after each step
  double gradient_norm_ = 0.0;
};

}  // namespace smoothfem
