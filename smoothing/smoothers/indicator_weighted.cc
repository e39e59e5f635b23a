// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "smoothing/base/parallel.h"
#include "smoothing/geometry/cell_size.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/invalid_node_reset.h"
#include "smoothing/solution/start_method.h"

namespace smoothfem {
namespace {

/// Weight rho^p of a cell, rho = sqrt(1 + (e / mean e)^2) with the error indicator e.
template <int dim>
struct OfAllDirections {
  using Weight = double;

  static std::vector<double> indicators(const ProblemSolver<dim>& solver) {
    return solver.recovery_indicators();
  }
  static double size(double e) { return e; }
  static double weight(double e, double mean, double power) {
    return std::pow(1.0 + (e / mean) * (e / mean), 0.5 * power);
  }
  static double identity() { return 1.0; }
  /// A fraction of the mean of pulls: sum by their weights.
  static Point<dim> step(double fraction, const Point<dim>& sum, double weights) {
    return weights > 0.0 ? Point<dim>(fraction / weights * sum) : Point<dim>(Point<dim>::Zero());
  }
};

/// The same by the indicator's tensor T, whose trace is e^2: (I + T / (mean e)^2)^(p/2). Where the
/// gradient errs into one direction nodes are pulled along it by rho^p, but across it by 1, so that
/// cells become thin there and not small.
template <int dim>
struct OfEachDirection {
  using Weight = CellTensor<dim>;

  static std::vector<Weight> indicators(const ProblemSolver<dim>& solver) {
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

/// Cells in which the solution's error is large pull their nodes together: weighted Laplace with
/// the cells' sizes times a weight in place of the sizes (Eq. 1.2), from an error indicator of the
/// solution at hand. Some sweeps, then the next solve. The result is the mesh of the lowest energy,
/// and with it of the lowest true error.
template <int dim, template <int> class Directions>
class IndicatorWeighted final : public Smoother<dim> {
 public:
  std::string_view name() const override { return "weights"; }
  Parameters parameters() override {
    return {
        {"degree", "of the finite elements whose error is to fall", &degree_, 1.0, 2.0},
        {"solves", "of the problem at most, the one on the mesh it begins with included",
         &n_solves_, 1.0, 1e6},
        {"power",
         "exponent p of the weights rho^p, rho = sqrt(1 + (e / mean e)^2) with the indicator "
         "e; 4 and more has been seen to break meshes",
         &power_, 0.0, 100.0},
        {"sweeps", "of weighted Laplace between two solves", &n_sweeps_, 1.0, 1e6},
        {"relaxation", "fraction of the way that nodes go", &relaxation_, 0.0, 1.0, true},
        {"averagings", "of the indicator over cells around the nodes", &n_averagings_, 0.0, 1e3},
        {"quality_floor",
         "mean ratio below which nodes of cells are put back; the lowest of the mesh at hand "
         "where that is lower",
         &quality_floor_, 0.0, 1.0}};
  }
  SmootherTraits traits() const override {
    return {.quality_use = QualityUse::smoother, .result = ResultMesh::best_score};
  }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::step_says_so};
  }

  void initialize(const SmoothingState<dim>& state) override {
    is_done_ = state.mesh.topology().free_nodes().empty();
    if (is_done_) return;
    n_solves_before_ = state.solver->effort().n_solves;
    state.solver->prepare(state.mesh, degree_);
    energy_ = state.solver->solve(state.mesh.coordinates());
    is_done_ = !std::isfinite(energy_);
  }
  double initial_score() const override { return -energy_; }

  StepReport step(SmoothingState<dim>& state) override {
    StepReport report;
    is_done_ = is_done_ || n_solves(state) >= n_solves_;
    if (!is_done_) {
      const auto weights = cell_weights(state);
      const double lowest_quality = std::min(
          quality_floor_, *std::min_element(state.cell_quality.begin(), state.cell_quality.end()));
      for (int sweep = 0; sweep < n_sweeps_; ++sweep)
        report.n_reset += sweep_nodes(state, weights, lowest_quality);
      energy_ = state.solver->solve(state.mesh.coordinates());
      is_done_ = !std::isfinite(energy_) || n_solves(state) >= n_solves_;
    }
    report.score = -energy_;
    report.quality = mesh_quality(state.mesh.topology(), state.cell_quality);
    report.converged = is_done_;
    return report;
  }

 private:
  using Weight = typename Directions<dim>::Weight;

  int n_solves(const SmoothingState<dim>& state) const {
    return static_cast<int>(state.solver->effort().n_solves - n_solves_before_);
  }

  std::vector<Weight> cell_weights(const SmoothingState<dim>& state) const {
    auto weights = Directions<dim>::indicators(*state.solver);
    for (int k = 0; k < n_averagings_; ++k) average(state.mesh.topology(), weights);
    double mean = 0.0;
    for (const Weight& e : weights) mean += Directions<dim>::size(e);
    mean /= static_cast<double>(weights.size());
    for (Weight& e : weights)
      e = mean > 0.0 ? Directions<dim>::weight(e, mean, power_) : Directions<dim>::identity();
    return weights;
  }

  /// Each cell gets the mean of its nodes, which have the mean of the cells around them.
  static void average(const Topology& topology, std::vector<Weight>& of_cells) {
    const Weight zero = 0.0 * Directions<dim>::identity();
    std::vector<Weight> of_nodes(topology.n_nodes(), zero);
    for (NodeIndex i = 0; i < topology.n_nodes(); ++i) {
      const auto cells = topology.node_cells(i);
      for (const CellIndex c : cells) of_nodes[i] += of_cells[c];
      if (!cells.empty()) of_nodes[i] /= static_cast<double>(cells.size());
    }
    for (CellIndex c = 0; c < topology.n_cells(); ++c) {
      const auto nodes = topology.cell_nodes(c);
      of_cells[c] = zero;
      for (const NodeIndex i : nodes) of_cells[c] += of_nodes[i];
      of_cells[c] /= static_cast<double>(nodes.size());
    }
  }

  /// One sweep of all nodes at once; returns how many were put back.
  std::size_t sweep_nodes(SmoothingState<dim>& state, const std::vector<Weight>& weights,
                          double lowest_quality) {
    Mesh<dim>& mesh = state.mesh;
    const Topology& topology = mesh.topology();
    pulls_.resize(mesh.n_cells());
    previous_.resize(mesh.n_nodes());
    constexpr std::size_t grain = 512;
    parallel_for_ranges(mesh.n_cells(), grain, [&](std::size_t first, std::size_t last) {
      for (auto c = static_cast<CellIndex>(first); c < last; ++c)
        pulls_[c] = {centroid(mesh, c), weights[c] * std::abs(signed_cell_size(mesh, c))};
    });
    parallel_for_ranges(mesh.n_nodes(), grain, [&](std::size_t first, std::size_t last) {
      for (auto i = static_cast<NodeIndex>(first); i < last; ++i)
        previous_[i] = topology.is_fixed(i) ? mesh.coordinates()[i] : relaxed_mean(mesh, i);
    });
    mesh.swap_coordinates(previous_);
    compute_cell_mean_ratios(mesh, state.cell_quality);
    return reset_nodes_of_invalid_cells(mesh, previous_, state.cell_quality, lowest_quality).size();
  }

  static Point<dim> centroid(const Mesh<dim>& mesh, CellIndex c) {
    const auto nodes = mesh.topology().cell_nodes(c);
    Point<dim> sum = Point<dim>::Zero();
    for (const NodeIndex i : nodes) sum += mesh.coordinates()[i];
    return sum / static_cast<double>(nodes.size());
  }

  /// Seen from the node, so that a mesh far from the origin moves as one near it.
  Point<dim> relaxed_mean(const Mesh<dim>& mesh, NodeIndex i) const {
    const Point<dim>& here = mesh.coordinates()[i];
    Point<dim> sum = Point<dim>::Zero();
    Weight total = 0.0 * Directions<dim>::identity();
    for (const CellIndex c : mesh.topology().node_cells(i)) {
      sum += pulls_[c].weight * (pulls_[c].centroid - here);
      total += pulls_[c].weight;
    }
    return here + Directions<dim>::step(relaxation_, sum, total);
  }

  struct Pull {
    Point<dim> centroid;
    Weight weight;
  };

  int degree_ = 1;
  int n_solves_ = 10;
  double power_ = 2.5;
  int n_sweeps_ = 15;
  double relaxation_ = 0.8;
  int n_averagings_ = 1;
  double quality_floor_ = 0.1;

  std::size_t n_solves_before_ = 0;
  double energy_ = 0.0;
  bool is_done_ = false;
  std::vector<Pull> pulls_;  ///< of each cell on its nodes
  std::vector<Point<dim>> previous_;
};

template <int dim, template <int> class Directions>
Stages<dim> weighted() {
  Stages<dim> stages;
  stages.push_back(std::make_unique<StartMethod<dim>>());
  stages.push_back(std::make_unique<IndicatorWeighted<dim, Directions>>());
  return stages;
}

/// Large movements first, then those that only the energy sees.
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
                    "the solution; a solve an iteration",
     .source = "indicator of Zienkiewicz and Zhu 1987",
     .needs_problem = true},
    {weighted<2, OfAllDirections>, weighted<3, OfAllDirections>});
const RegisteredMethod by_direction(
    {.name = "indicator-aligned",
     .title = "Indicator-aligned",
     .description = "as indicator-weighted, with weights for each direction: cells become thin "
                    "across a front or layer, and stay long along it",
     .source = "indicator of Zienkiewicz and Zhu 1987",
     .needs_problem = true},
    {weighted<2, OfEachDirection>, weighted<3, OfEachDirection>});
const RegisteredMethod with_descent(
    {.name = "indicator-weighted-descent",
     .title = "Indicator-weighted, descent",
     .description = "indicator-weighted from GETMe's mesh, then energy-descent",
     .source = "the two",
     .needs_problem = true},
    {weighted_and_descent<2>, weighted_and_descent<3>});

}  // namespace
}  // namespace smoothfem
