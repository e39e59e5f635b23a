// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "smoothing/base/parallel.h"
#include "smoothing/getme/element_pass.h"
#include "smoothing/getme/simultaneous_elements.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/invalid_node_reset.h"
#include "smoothing/solution/cell_averages.h"
#include "smoothing/solution/error_indicators.h"
#include "smoothing/solution/solution_driven.h"
#include "smoothing/solution/start_method.h"
#include "smoothing/transformations/scaling.h"

namespace smoothfem {
namespace {

/// GETMe simultaneous (thesis, Section 4.2) whose transformed elements are scaled to target sizes.
/// Elements get small where an error indicator e of the present solution is large compared with the
/// cell's width h. Target sizes are s ~ rho^-p with rho = sqrt(1 + (c / mean c)^2) and c = e / h;
/// their sum equals that of the cells' sizes.
///
/// In dimension d, p = 2 d / (d + 2) would give the smallest error of the gradient for elements of
/// degree 1 and a fixed number of cells. But cells reach their targets only in part, as a node
/// moves to the mean of the positions that several elements request. The default is therefore
/// larger. Many sweeps are needed, as each moves nodes little.
template <int dim>
class IndicatorGetme final : public SolutionDriven<dim> {
 public:
  IndicatorGetme() : SolutionDriven<dim>(0.1) { element_.scaling = element_.neighbour_mean_size; }

  std::string_view name() const override { return "sizes"; }
  Parameters parameters() override {
    Parameters all = this->common_parameters();
    const Parameters own{
        indicator_choice(&indicator_),
        {"power",
         "exponent p of the target sizes rho^-p, rho = sqrt(1 + (c / mean c)^2), c = e / h with "
         "the indicator e of a cell of width h",
         &power_, 0.0, 100.0},
        {"sweeps", "sweeps of GETMe simultaneous between two solves", &n_sweeps_, 1.0, 1e6},
        {"averagings", "averagings of the indicator over cells around the nodes", &n_averagings_,
         0.0, 1e3}};
    all.insert(all.end(), own.begin(), own.end());
    return all;
  }

 private:
  void prepare(const SmoothingState<dim>& state) override {
    pass_.prepare(state.mesh, element_);
    previous_.resize(state.mesh.n_nodes());
  }

  std::size_t move_nodes(SmoothingState<dim>& state) override {
    constexpr double eta = 0.0;  // the plain mean of Eq. 4.2
    set_target_sizes(state);
    pass_.prescribe_sizes(target_sizes_);
    std::size_t n_reset = 0;
    for (int sweep = 0; sweep < n_sweeps_; ++sweep) {
      pass_.transform_all(state, eta);
      move_to_means(state.mesh);
      compute_cell_mean_ratios(state.mesh, state.cell_quality);
      n_reset += reset_nodes_of_invalid_cells(state.mesh, previous_, state.cell_quality,
                                              this->lowest_quality())
                     .size();
    }
    return n_reset;
  }

  void move_to_means(Mesh<dim>& mesh) {
    constexpr std::size_t grain = 512;
    parallel_for_ranges(mesh.n_nodes(), grain, [&](std::size_t first, std::size_t last) {
      for (auto i = static_cast<NodeIndex>(first); i < last; ++i) {
        const Point<dim>& here = mesh.coordinates()[i];
        previous_[i] = here;
        if (this->nodes().contains(i) && pass_.has_mean(i))
          previous_[i] += this->nodes().along(i, pass_.mean(i) - here);
      }
    });
    mesh.swap_coordinates(previous_);
  }

  void set_target_sizes(const SmoothingState<dim>& state) {
    const Topology& topology = state.mesh.topology();
    auto bends = error_indicators(*state.solver, indicator_);
    const auto sizes = cell_sizes(state.mesh);
    double mean = 0.0, total = 0.0;
    for (CellIndex c = 0; c < topology.n_cells(); ++c) bends[c] /= std::pow(sizes[c], 1.0 / dim);
    for (int k = 0; k < n_averagings_; ++k) average_over_nodes(topology, 0.0, bends);
    for (CellIndex c = 0; c < topology.n_cells(); ++c) {
      mean += sizes[c] * bends[c];
      total += sizes[c];
    }
    mean /= total;
    target_sizes_.resize(topology.n_cells());
    double sum = 0.0, sum_of_targets = 0.0;
    for (CellIndex c = 0; c < topology.n_cells(); ++c) {
      const double relative = mean > 0.0 ? bends[c] / mean : 0.0;
      target_sizes_[c] = std::pow(1.0 + relative * relative, -0.5 * power_);
      with_corners<dim>(topology.cell_nodes(c), state.mesh.coordinates().data(),
                        [&](auto corners) { sum += std::abs(node_simplex_size<dim>(corners)); });
      sum_of_targets += target_sizes_[c];
    }
    for (double& size : target_sizes_) size *= sum / sum_of_targets;
  }

  ElementParameters<dim> element_ = simultaneous_elements<dim>();
  int indicator_ = recovery;
  double power_ = 2.0;
  int n_sweeps_ = 100;
  int n_averagings_ = 1;

  ElementPass<dim> pass_;
  std::vector<double> target_sizes_;  ///< of each cell, in the form of ElementPass
  std::vector<Point<dim>> previous_;
};

template <int dim>
Stages<dim> make_stages() {
  Stages<dim> stages;
  stages.push_back(std::make_unique<StartMethod<dim>>());
  stages.push_back(std::make_unique<IndicatorGetme<dim>>());
  return stages;
}

const RegisteredMethod registered(
    {.name = "indicator-getme",
     .title = "Indicator-sized GETMe",
     .description = "GETMe, then GETMe simultaneous whose elements are scaled to target sizes from "
                    "an error indicator of the solution; one solve in each iteration",
     .source = "Section 4.2; indicator of Zienkiewicz and Zhu 1987",
     .problem_use = {.indicators = true}},
    {make_stages<2>, make_stages<3>});

}  // namespace
}  // namespace smoothfem
