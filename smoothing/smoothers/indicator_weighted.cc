// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "smoothing/base/parallel.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/invalid_node_reset.h"
#include "smoothing/solution/cell_averages.h"
#include "smoothing/solution/error_indicators.h"
#include "smoothing/solution/solution_driven.h"
#include "smoothing/solution/start_method.h"

namespace smoothfem {
namespace {

/// Weight rho^p of a cell, rho = sqrt(1 + (e / mean e)^2) with the error indicator e.
template <int dim>
struct OfAllDirections {
  using Weight = double;

  static Parameters parameters(int* indicator) { return {indicator_choice(indicator)}; }
  static std::vector<double> indicators(const ProblemSolver<dim>& solver, int indicator) {
    return error_indicators(solver, indicator);
  }
  static double size(double e) { return e; }
  static double weight(double e, double mean, double power) {
    return std::pow(1.0 + (e / mean) * (e / mean), 0.5 * power);
  }
  static double identity() { return 1.0; }
  /// Returns a fraction of the mean of pulls: their sum divided by their weights.
  static Point<dim> step(double fraction, const Point<dim>& sum, double weights) {
    return weights > 0.0 ? Point<dim>(fraction / weights * sum) : Point<dim>(Point<dim>::Zero());
  }
};

/// Weight by the indicator's tensor T, whose trace is e^2: (I + T / (mean e)^2)^(p/2). In the
/// direction of the gradient's error nodes are pulled by rho^p, across it by 1. So cells become
/// thin in that direction, and not small.
template <int dim>
struct OfEachDirection {
  using Weight = CellTensor<dim>;

  static Parameters parameters(int* /*indicator*/) { return {}; }
  static std::vector<Weight> indicators(const ProblemSolver<dim>& solver, int /*indicator*/) {
    return solver.recovery_tensors();
  }
  static double size(const Weight& t) { return std::sqrt(t.trace()); }
  static Weight weight(const Weight& t, double mean, double power) {
    const Eigen::SelfAdjointEigenSolver<Weight> eigen(t / (mean * mean));
    Point<dim> weights;
    for (int d = 0; d < dim; ++d)
      weights[d] = std::pow(1.0 + std::max(0.0, eigen.eigenvalues()[d]), 0.5 * power);
    return eigen.eigenvectors() * weights.asDiagonal() * eigen.eigenvectors().transpose();
  }
  static Weight identity() { return Weight::Identity(); }
  static Point<dim> step(double fraction, const Point<dim>& sum, const Weight& weights) {
    return weights.trace() > 0.0 ? Point<dim>(fraction * (weights.inverse() * sum))
                                 : Point<dim>(Point<dim>::Zero());
  }
};

/// Weighted Laplace (Eq. 1.2) in which the size of each cell is multiplied by a weight from an
/// error indicator of the present solution. Cells with a large error pull their nodes together.
/// Alternates a few sweeps and a solve.
template <int dim, template <int> class Directions>
class IndicatorWeighted final : public SolutionDriven<dim> {
 public:
  IndicatorWeighted() : SolutionDriven<dim>(0.1) {}

  std::string_view name() const override { return "weights"; }
  Parameters parameters() override {
    Parameters all = this->common_parameters();
    const Parameters own{
        {"power",
         "exponent p of the weights rho^p, rho = sqrt(1 + (e / mean e)^2) with the indicator "
         "e; values of 4 and more have broken meshes",
         &power_, 0.0, 100.0},
        {"sweeps", "sweeps of weighted Laplace between two solves", &n_sweeps_, 1.0, 1e6},
        {"relaxation", "fraction of the way to the weighted mean that nodes move", &relaxation_,
         0.0, 1.0, true},
        {"averagings", "averagings of the indicator over cells around the nodes", &n_averagings_,
         0.0, 1e3}};
    all.insert(all.end(), own.begin(), own.end());
    for (const Parameter& parameter : Directions<dim>::parameters(&indicator_))
      all.push_back(parameter);
    return all;
  }

 private:
  using Weight = typename Directions<dim>::Weight;

  std::size_t move_nodes(SmoothingState<dim>& state) override {
    const auto weights = cell_weights(state);
    std::size_t n_reset = 0;
    for (int sweep = 0; sweep < n_sweeps_; ++sweep) n_reset += sweep_nodes(state, weights);
    return n_reset;
  }

  std::vector<Weight> cell_weights(const SmoothingState<dim>& state) const {
    auto weights = Directions<dim>::indicators(*state.solver, indicator_);
    const Weight zero = 0.0 * Directions<dim>::identity();
    for (int k = 0; k < n_averagings_; ++k)
      average_over_nodes(state.mesh.topology(), zero, weights);
    double mean = 0.0;
    for (const Weight& e : weights) mean += Directions<dim>::size(e);
    mean /= static_cast<double>(weights.size());
    for (Weight& e : weights)
      e = mean > 0.0 ? Directions<dim>::weight(e, mean, power_) : Directions<dim>::identity();
    return weights;
  }

  /// Makes one sweep of all nodes at once. Returns the number of nodes that were reset.
  std::size_t sweep_nodes(SmoothingState<dim>& state, const std::vector<Weight>& weights) {
    Mesh<dim>& mesh = state.mesh;
    pulls_.resize(mesh.n_cells());
    previous_.resize(mesh.n_nodes());
    constexpr std::size_t grain = 512;
    parallel_for_ranges(mesh.n_cells(), grain, [&](std::size_t first, std::size_t last) {
      for (auto c = static_cast<CellIndex>(first); c < last; ++c)
        pulls_[c] = {centroid(mesh, c), weights[c] * std::abs(signed_cell_size(mesh, c))};
    });
    parallel_for_ranges(mesh.n_nodes(), grain, [&](std::size_t first, std::size_t last) {
      for (auto i = static_cast<NodeIndex>(first); i < last; ++i)
        previous_[i] = this->nodes().contains(i) ? relaxed_mean(mesh, i) : mesh.coordinates()[i];
    });
    mesh.swap_coordinates(previous_);
    compute_cell_mean_ratios(mesh, state.cell_quality);
    return reset_nodes_of_invalid_cells(mesh, previous_, state.cell_quality, this->lowest_quality())
        .size();
  }

  static Point<dim> centroid(const Mesh<dim>& mesh, CellIndex c) {
    const auto nodes = mesh.topology().cell_nodes(c);
    Point<dim> sum = Point<dim>::Zero();
    for (const NodeIndex i : nodes) sum += mesh.coordinates()[i];
    return sum / static_cast<double>(nodes.size());
  }

  /// Relative to the node, so that a mesh far from the origin moves like one near it.
  Point<dim> relaxed_mean(const Mesh<dim>& mesh, NodeIndex i) const {
    const Point<dim>& here = mesh.coordinates()[i];
    Point<dim> sum = Point<dim>::Zero();
    Weight total = 0.0 * Directions<dim>::identity();
    for (const CellIndex c : mesh.topology().node_cells(i)) {
      sum += pulls_[c].weight * (pulls_[c].centroid - here);
      total += pulls_[c].weight;
    }
    return here + this->nodes().along(i, Directions<dim>::step(relaxation_, sum, total));
  }

  struct Pull {
    Point<dim> centroid;
    Weight weight;
  };

  int indicator_ = recovery;
  double power_ = 2.5;
  int n_sweeps_ = 15;
  double relaxation_ = 0.8;
  int n_averagings_ = 1;

  std::vector<Pull> pulls_;  ///< pull of each cell on its nodes
  std::vector<Point<dim>> previous_;
};

template <int dim, template <int> class Directions>
Stages<dim> weighted() {
  Stages<dim> stages;
  stages.push_back(std::make_unique<StartMethod<dim>>());
  stages.push_back(std::make_unique<IndicatorWeighted<dim, Directions>>());
  return stages;
}

/// Makes large movements first, then movements that only the energy detects.
template <int dim>
Stages<dim> weighted_and_descent() {
  auto stages = weighted<dim, OfAllDirections>();
  stages.push_back(std::move(stages_of<dim>("energy-descent").back()));
  return stages;
}

const RegisteredMethod registered(
    {.name = "indicator-weighted",
     .title = "Indicator-weighted",
     .description = "GETMe, then weighted Laplace whose weights grow with an error indicator of "
                    "the solution; one solve in each iteration",
     .source = "indicator of Zienkiewicz and Zhu 1987",
     .problem_use = {.indicators = true}},
    {weighted<2, OfAllDirections>, weighted<3, OfAllDirections>});
const RegisteredMethod by_direction(
    {.name = "indicator-aligned",
     .title = "Indicator-aligned",
     .description = "indicator-weighted with a weight for each direction: cells become thin "
                    "across a front or layer, and stay long along it",
     .source = "indicator of Zienkiewicz and Zhu 1987",
     .problem_use = {.directions = true}},
    {weighted<2, OfEachDirection>, weighted<3, OfEachDirection>});
const RegisteredMethod with_descent(
    {.name = "indicator-weighted-descent",
     .title = "Indicator-weighted, descent",
     .description = "indicator-weighted from GETMe's mesh, then energy-descent",
     .source = "the two",
     .problem_use = {.energy_gradient = true, .indicators = true}},
    {weighted_and_descent<2>, weighted_and_descent<3>});

}  // namespace
}  // namespace smoothfem
