// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/invalid_node_reset.h"
#include "smoothing/solution/cell_averages.h"
#include "smoothing/solution/error_metric.h"
#include "smoothing/solution/mesh_functional.h"
#include "smoothing/solution/node_descent.h"
#include "smoothing/solution/solution_driven.h"
#include "smoothing/solution/start_method.h"

namespace smoothfem {
namespace {

/// Moving mesh method of Huang and Kamenski (2015). Cells become alike in a metric made from the
/// second derivatives of the solution: small where it bends, and thin across the direction in which
/// it bends. Between two solves, nodes descend the mesh functional while the metric stays fixed in
/// space. The authors follow the gradient flow in a mesh time; here the Laplacian of the nodes and
/// BFGS reach the same mesh in far fewer steps.
template <int dim>
class IndicatorMmpde final : public SolutionDriven<dim> {
 public:
  IndicatorMmpde() : SolutionDriven<dim>(0.02) {}

  std::string_view name() const override { return "mmpde"; }
  Parameters parameters() override {
    Parameters all = this->common_parameters();
    const Parameters own{
        {"concentration",
         "c: a fraction 1 - 1/c of the cells moves to where the solution bends; c - 1 is halved "
         "when "
         "the estimated error has fallen by less than 1 %",
         &concentration_, 1.0, 1e6, true},
        {"averagings", "averagings of the second derivatives over cells around the nodes",
         &n_averagings_, 0.0, 1e3},
        {"steps", "largest number of descent steps of the functional between two solves", &n_steps_,
         1.0, 1e6}};
    all.insert(all.end(), own.begin(), own.end());
    return all;
  }

 private:
  void prepare(const SmoothingState<dim>& state) override {
    functional_ = std::make_unique<MeshFunctional<dim>>(state.mesh);
    descent_ = std::make_unique<NodeDescent<dim>>(state.mesh.topology(), this->nodes(), n_pairs);
    concentration_now_ = concentration_;
    min_error_ = std::numeric_limits<double>::infinity();
  }

  std::size_t move_nodes(SmoothingState<dim>& state) override {
    choose_concentration(state);
    const auto before = state.mesh.copied_coordinates();
    functional_->set_metric(metric(state));
    descend(state.mesh);
    compute_cell_mean_ratios(state.mesh, state.cell_quality);
    return reset_nodes_of_invalid_cells(state.mesh, before, state.cell_quality,
                                        this->lowest_quality())
        .size();
  }

  /// A lower concentration is better if there are too few cells, for example next to a boundary
  /// that stays.
  void choose_concentration(const SmoothingState<dim>& state) {
    constexpr double min_gain = 0.01;
    const double error = this->estimated_error(state);
    if (error > (1.0 - min_gain) * min_error_)
      concentration_now_ = 0.5 * (1.0 + concentration_now_);
    min_error_ = std::min(min_error_, error);
  }

  bool has_more_to_try() const override {
    constexpr double hardly_any = 1.2;
    return concentration_now_ > std::min(hardly_any, 0.5 * (1.0 + concentration_));
  }

  TensorField<dim> metric(const SmoothingState<dim>& state) const {
    auto hessians = state.solver->recovered_hessians();
    for (int k = 0; k < n_averagings_; ++k)
      average_over_nodes(state.mesh.topology(), CellTensor<dim>(CellTensor<dim>::Zero()), hessians);
    const auto sizes = cell_sizes(state.mesh);
    return TensorField<dim>(state.mesh, error_metric<dim>(hessians, sizes, concentration_now_),
                            sizes);
  }

  /// The functional is infinite for an invalid cell, so that no cell becomes invalid.
  void descend(Mesh<dim>& mesh) {
    constexpr double min_gain = 1e-6;
    auto base = mesh.copied_coordinates();
    double lowest = functional_->value(mesh);
    bool has_direction = false;
    descent_->restart();
    for (int k = 0; k < n_steps_ && !descent_->is_stuck(); ++k) {
      if (!has_direction) descent_->choose_direction(mesh, functional_->gradient());
      descent_->move_from(base, mesh);
      const double value = functional_->value(mesh);
      has_direction = !(value < lowest);
      if (has_direction) {
        descent_->reject();
        continue;
      }
      descent_->accept(base, mesh);
      base = mesh.copied_coordinates();
      const double gain = (lowest - value) / lowest;
      lowest = value;
      if (gain < min_gain) return;
    }
    mesh.set_coordinates(base);
  }

  static constexpr int n_pairs = 10;  ///< for BFGS

  double concentration_ = 5.0;
  int n_averagings_ = 2;
  int n_steps_ = 200;

  double concentration_now_ = 0.0, min_error_ = 0.0;
  std::unique_ptr<MeshFunctional<dim>> functional_;
  std::unique_ptr<NodeDescent<dim>> descent_;
};

template <int dim>
Stages<dim> make_stages() {
  Stages<dim> stages;
  stages.push_back(std::make_unique<StartMethod<dim>>());
  stages.push_back(std::make_unique<IndicatorMmpde<dim>>());
  return stages;
}

/// Makes large movements first, then movements that only the energy detects.
template <int dim>
Stages<dim> with_descent() {
  auto stages = make_stages<dim>();
  stages.push_back(std::move(stages_of<dim>("energy-descent").back()));
  return stages;
}

const RegisteredMethod registered(
    {.name = "indicator-mmpde",
     .title = "MMPDE",
     .description = "GETMe, then a moving mesh method: cells become alike in a metric of the "
                    "solution's recovered second derivatives; one solve in each iteration",
     .source = "Huang, Kamenski 2015, arXiv 1410.7872",
     .problem_use = {.directions = true}},
    {make_stages<2>, make_stages<3>});
const RegisteredMethod and_descent({.name = "indicator-mmpde-descent",
                                    .title = "MMPDE, descent",
                                    .description = "indicator-mmpde from GETMe's mesh, then "
                                                   "energy-descent",
                                    .source = "the two",
                                    .problem_use = {.energy_gradient = true, .directions = true}},
                                   {with_descent<2>, with_descent<3>});

}  // namespace
}  // namespace smoothfem
