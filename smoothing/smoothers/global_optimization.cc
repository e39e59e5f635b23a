// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "smoothing/loop/catalogue.h"
#include "smoothing/optimization/feasible_movement.h"
#include "smoothing/optimization/feasible_newton.h"
#include "smoothing/optimization/shape_objective.h"
#include "smoothing/optimization/vertex_descent.h"
#include "smoothing/parts/whole_mesh.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {
namespace {

/// The feasible Newton method (feasible_newton.h) for the shape objective of linear cells.
template <int dim>
class GlobalOptimization final : public Smoother<dim> {
 public:
  std::string_view name() const override { return "global-optimization"; }

  Parameters parameters() override {
    Parameters all = newton_parameters_.list("an element's corner");
    const Parameters own{
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
    all.insert(all.end(), own.begin(), own.end());
    return all;
  }

  SmootherTraits traits() const override {
    const bool best = result_ != 0;  // the method itself uses no mean ratio
    return {.quality_use = best ? QualityUse::loop : QualityUse::none,
            .result = best ? ResultMesh::best_q_mean : ResultMesh::last,
            .takes_targets = true,
            .works_in_parts = true};
  }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::step_says_so, .max_iterations = max_iterations_};
  }

  void initialize(const SmoothingState<dim>& state) override {
    if (start_sweeps_ > 0 && state.mesh.targets())
      throw InputError(
          "method global-optimization: start_sweeps cannot be used with targets; set it to 0");
    if (start_sweeps_ > 0 && state.mesh.topology().part())
      throw InputError(
          "method global-optimization: start_sweeps visit one node after the other, which does not "
          "work in parts of a mesh; set it to 0");
    objective_.emplace(state.mesh.shared_topology(), state.mesh.shared_targets(), size_weight_);
    newton_.emplace(*objective_, newton_parameters_, state.mesh.coordinates());
    start_ = start_sweeps_ > 0;
  }

  StepReport step(SmoothingState<dim>& state) override {
    if (start_) sweep_nodes(state.mesh);
    return {.converged = newton_->step(
                state.mesh, [&](auto& newton, const Mesh<dim>& mesh) { limit(newton, mesh); })};
  }

 private:
  using Newton = FeasibleNewton<dim, ShapeObjective<dim>>;
  using Points = std::vector<Point<dim>>;

  void sweep_nodes(Mesh<dim>& mesh) {
    start_ = false;
    const VertexDescent<dim> descent(mesh.topology());
    for (int i = 0; i < start_sweeps_; ++i) descent.sweep(mesh.coordinates());
    newton_->move_to(mesh.coordinates());
  }

  /// Shortens the step of each node so that its elements keep positive determinants, in a few
  /// rounds; the line search handles the rest.
  void limit(Newton& newton, const Mesh<dim>& mesh) const {
    constexpr int max_rounds = 5;
    newton.shorten(mesh, max_rounds, [&](int, const Points& to, std::vector<double>& limits) {
      return WholeMesh(mesh.topology())
                 .min(feasible_fractions<dim>(mesh.topology(), mesh.coordinates(), to,
                                              newton_parameters_.determinant_fraction, limits)) !=
             1.0;
    });
    if (mesh.targets()) keep_sizes(newton, mesh);
  }

  /// Halves the steps of nodes whose cells would get sizes beyond the targets' bound, in the end to
  /// zero.
  static void keep_sizes(Newton& newton, const Mesh<dim>& mesh) {
    constexpr int max_halvings = 8;
    Mesh<dim> trial = mesh;
    std::vector<double> quality;
    newton.shorten(mesh, max_halvings + 1,
                   [&](int k, const Points& to, std::vector<double>& limits) {
                     trial.set_coordinates(to);
                     if (compute_cell_mean_ratios(trial, quality).n_invalid == 0) return false;
                     limits.assign(mesh.n_nodes(), 1.0);
                     for (CellIndex c = 0; c < mesh.n_cells(); ++c)
                       if (!(quality[c] > 0.0))
                         for (const NodeIndex i : mesh.topology().cell_nodes(c))
                           limits[i] = k < max_halvings ? 0.5 : 0.0;
                     return true;
                   });
  }

  NewtonParameters newton_parameters_;
  double size_weight_ = 30.0;
  int start_sweeps_ = 0;
  int max_iterations_ = 1000;
  int result_ = 0;

  std::optional<ShapeObjective<dim>> objective_;
  std::optional<Newton> newton_;
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
