// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/invalid_node_reset.h"
#include "smoothing/solution/limited_memory.h"
#include "smoothing/solution/node_laplacian.h"
#include "smoothing/solution/start_method.h"

namespace smoothfem {
namespace {

/// The number that a fraction of all are below.
double quantile(std::vector<double> numbers, double fraction) {
  const auto position = numbers.begin() + static_cast<std::ptrdiff_t>(
                                              fraction * static_cast<double>(numbers.size() - 1));
  std::nth_element(numbers.begin(), position, numbers.end());
  return *position;
}

/// Moves nodes down the energy J of the solution u_h: with fixed boundary nodes |grad(u - u_h)|^2 =
/// J + const, so that the true error falls without u being known. Each iteration solves once, on a
/// mesh that is kept if J is lower there. Minimizing over node positions is ill-posed (Mosler,
/// Ortiz 2006): the Laplacian L and the limits on steps and quality are what makes it a method.
template <int dim>
class EnergyDescent final : public Smoother<dim> {
 public:
  explicit EnergyDescent(int n_pairs) : n_pairs_(n_pairs) {}

  std::string_view name() const override { return "descent"; }
  Parameters parameters() override {
    return {
        {"degree", "of the finite elements whose error is to fall", &degree_, 1.0, 2.0},
        {"solves", "of the problem at most, the one on the mesh it begins with included",
         &n_solves_, 1.0, 1e6},
        {"memory", "pairs of steps and changes of the gradient for L-BFGS; 0: descent along L^-1 g",
         &n_pairs_, 0.0, 1e3},
        {"quality_floor",
         "mean ratio below which nodes of cells are put back; the lowest of the mesh at hand "
         "where that is lower",
         &quality_floor_, 0.0, 1.0},
        {"gain",
         "stop when a solve lowers the energy by less than this fraction of what all before "
         "did; 0: go on until 'solves'",
         &least_gain_, 0.0, 1.0}};
  }
  SmootherTraits traits() const override {
    return {.quality_use = QualityUse::smoother, .result = ResultMesh::last};
  }
  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::step_says_so};
  }

  void initialize(const SmoothingState<dim>& state) override {
    step_length_ = first_step_length;
    memory_ = LimitedMemory(static_cast<std::size_t>(n_pairs_));
    is_done_ = state.mesh.topology().free_nodes().empty();
    if (is_done_) return;
    n_solves_before_ = state.solver->effort().n_solves;
    laplacian_ = std::make_unique<NodeLaplacian>(state.mesh.topology());
    state.solver->prepare(state.mesh, degree_);
    energy_ = first_energy_ = state.solver->solve(state.mesh.coordinates());
    base_ = state.mesh.copied_coordinates();
    gradient_.resize(0, 0);
    has_direction_ = false;
    is_done_ = !std::isfinite(energy_);
  }

  StepReport step(SmoothingState<dim>& state) override {
    StepReport report;
    // Without an earlier solve the budget is used up by the one on the mesh it begins with.
    is_done_ = is_done_ || n_solves(state) >= n_solves_;
    if (!is_done_) {
      if (!has_direction_) choose_direction(state);
      report.n_reset = move_nodes(state);
      const double energy = state.solver->solve(state.mesh.coordinates());
      if (energy < energy_)
        accept(state, energy);
      else
        reject(state);
      is_done_ = is_done_ || n_solves(state) >= n_solves_ || step_length_ < least_step_length;
    }
    report.quality = mesh_quality(state.mesh.topology(), state.cell_quality);
    report.converged = is_done_;
    return report;
  }

 private:
  static constexpr double first_step_length = 0.2;  ///< in shortest edges: see scale_of_step
  static constexpr double largest_step_length = 0.6;
  static constexpr double least_step_length = 1e-4;
  static constexpr double longest_movement = 0.2;  ///< of any node, in its shortest edge

  int n_solves(const SmoothingState<dim>& state) const {
    return static_cast<int>(state.solver->effort().n_solves - n_solves_before_);
  }

  static const std::vector<NodeIndex>& free_nodes(const SmoothingState<dim>& state) {
    return state.mesh.topology().free_nodes();
  }

  /// A row for each free node.
  static NodeVectors rows_of(const std::vector<NodeIndex>& nodes,
                             std::span<const Point<dim>> vectors) {
    NodeVectors rows(nodes.size(), dim);
    for (std::size_t k = 0; k < nodes.size(); ++k)
      rows.row(static_cast<Eigen::Index>(k)) = vectors[nodes[k]].transpose();
    return rows;
  }

  /// z = L^-1 g, or the direction of L-BFGS while that leads down.
  void choose_direction(const SmoothingState<dim>& state) {
    const auto& nodes = free_nodes(state);
    const NodeVectors before = gradient_;
    gradient_ = rows_of(nodes, state.solver->energy_gradient());
    if (before.size() > 0) memory_.add(last_step_, gradient_ - before);
    direction_ = memory_.apply(gradient_, *laplacian_);
    if (!(direction_.cwiseProduct(gradient_).sum() > 0.0)) {
      memory_.clear();
      direction_ = laplacian_->solve(gradient_);
    }
    shortest_edges_.clear();
    for (const NodeIndex i : nodes) shortest_edges_.push_back(shortest_edge(state.mesh, i));
    lowest_quality_ = std::min(
        quality_floor_, *std::min_element(state.cell_quality.begin(), state.cell_quality.end()));
    has_direction_ = true;
  }

  static double shortest_edge(const Mesh<dim>& mesh, NodeIndex i) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const NodeIndex j : mesh.topology().node_neighbours(i))
      shortest = std::min(shortest, (mesh.coordinates()[j] - mesh.coordinates()[i]).norm());
    return shortest;
  }

  /// t such that 99 of 100 movements t |z_i| are no longer than the step length times the shortest
  /// edge there; no more than 1 where L-BFGS knows how far to go.
  double scale_of_step() const {
    std::vector<double> lengths;
    for (std::size_t k = 0; k < shortest_edges_.size(); ++k)
      lengths.push_back(direction_.row(static_cast<Eigen::Index>(k)).norm() / shortest_edges_[k]);
    const double length = quantile(std::move(lengths), 0.99);
    const double scale = length > 0.0 ? step_length_ / length : 0.0;
    return memory_.empty() ? scale : std::min(1.0, scale);
  }

  /// Returns how many nodes were put back.
  std::size_t move_nodes(SmoothingState<dim>& state) {
    const auto& nodes = free_nodes(state);
    const double scale = scale_of_step();
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const Point<dim> move = -scale * direction_.row(static_cast<Eigen::Index>(k)).transpose();
      const double limit = longest_movement * shortest_edges_[k], length = move.norm();
      state.mesh.coordinates()[nodes[k]] =
          base_[nodes[k]] + (length > limit ? limit / length : 1.0) * move;
    }
    compute_cell_mean_ratios(state.mesh, state.cell_quality);
    return reset_nodes_of_invalid_cells(state.mesh, base_, state.cell_quality, lowest_quality_)
        .size();
  }

  void accept(const SmoothingState<dim>& state, double energy) {
    const double gain = energy_ - energy, gain_before = first_energy_ - energy_;
    is_done_ = gain_before > 0.0 && gain < least_gain_ * gain_before;
    const auto& nodes = free_nodes(state);
    last_step_ = rows_of(nodes, state.mesh.coordinates()) - rows_of(nodes, base_);
    energy_ = energy;
    base_ = state.mesh.copied_coordinates();
    has_direction_ = false;
    step_length_ = std::min(1.5 * step_length_, largest_step_length);
  }

  void reject(SmoothingState<dim>& state) {
    state.mesh.set_coordinates(base_);
    compute_cell_mean_ratios(state.mesh, state.cell_quality);
    step_length_ *= 0.4;
  }

  int degree_ = 1;
  int n_solves_ = 10;
  int n_pairs_;
  double quality_floor_ = 0.3;
  double least_gain_ = 0.0;

  std::unique_ptr<NodeLaplacian> laplacian_;
  LimitedMemory memory_{0};
  std::size_t n_solves_before_ = 0;
  double energy_ = 0.0, first_energy_ = 0.0;
  double step_length_ = first_step_length;
  double lowest_quality_ = 0.0;
  std::vector<Point<dim>> base_;  ///< the mesh of the lowest energy so far
  NodeVectors gradient_, direction_, last_step_;
  std::vector<double> shortest_edges_;  ///< of each free node
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
                                .description = "GETMe, then nodes move down the energy of the "
                                               "solution, and with it the true error; a solve "
                                               "an iteration",
                                .source = "Delfour, Payre, Zolésio 1985; Sobolev gradient",
                                .needs_problem = true},
                               {make_stages<2, 0>, make_stages<3, 0>});
const RegisteredMethod lbfgs({.name = "energy-lbfgs",
                              .title = "Energy L-BFGS",
                              .description = "the same by limited-memory BFGS",
                              .source = "Nocedal 1980",
                              .needs_problem = true},
                             {make_stages<2, 10>, make_stages<3, 10>});

}  // namespace
}  // namespace smoothfem
