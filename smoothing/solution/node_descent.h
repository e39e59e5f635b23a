// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <limits>
#include <memory>

#include "smoothing/solution/limited_memory.h"
#include "smoothing/solution/movable_nodes.h"
#include "smoothing/solution/node_laplacian.h"

namespace smoothfem {

/// Lowers a function J of node positions: along L^-1 g, with g its gradient and L the Laplacian of
/// the nodes, or along the direction of limited-memory BFGS. Minimizing over node positions is
/// ill-posed (Mosler, Ortiz 2006); L and limits on the steps regularize it.
template <int dim>
class NodeDescent {
 public:
  /// n_pairs: for BFGS; 0: along L^-1 g. nodes: the moving ones; must outlive this.
  NodeDescent(const Topology& topology, const MovableNodes<dim>& nodes, int n_pairs)
      : nodes_(nodes),
        laplacian_(topology, nodes.nodes()),
        memory_(static_cast<std::size_t>(n_pairs)) {}

  /// Forgets the history, for another function or another position.
  void restart() {
    memory_.clear();
    gradient_.resize(0, 0);
    step_length_ = first_step_length;
  }

  /// Chooses the direction from a mesh. gradient: dJ / dx_i there, for each node of the mesh.
  void choose_direction(const Mesh<dim>& mesh, std::span<const Point<dim>> gradient) {
    const NodeVectors before = gradient_;
    gradient_ = rows(gradient);
    keep_along(gradient_);
    if (before.size() > 0) memory_.add(last_step_, gradient_ - before);
    const auto inverse = [this](const NodeVectors& r) {
      NodeVectors z = laplacian_.solve(r);
      keep_along(z);
      return z;
    };
    direction_ = memory_.apply(gradient_, inverse);
    if (!(direction_.cwiseProduct(gradient_).sum() > 0.0)) {
      memory_.clear();
      direction_ = inverse(gradient_);
    }
    shortest_edges_.clear();
    for (const NodeIndex i : nodes_.nodes()) shortest_edges_.push_back(shortest_edge(mesh, i));
  }

  /// Moves the mesh's nodes a step from `base`, the mesh on which the direction was chosen.
  void move_from(std::span<const Point<dim>> base, Mesh<dim>& mesh) const {
    const double scale = scale_of_step();
    for (std::size_t k = 0; k < nodes_.nodes().size(); ++k) {
      const NodeIndex i = nodes_.nodes()[k];
      const Point<dim> move = -scale * row(direction_, k);
      const double limit = max_movement * shortest_edges_[k], length = move.norm();
      mesh.coordinates()[i] = base[i] + (length > limit ? limit / length : 1.0) * move;
    }
  }

  /// Accepts a step from `base` to the mesh, where J is lower: the next step may be longer.
  void accept(std::span<const Point<dim>> base, const Mesh<dim>& mesh) {
    last_step_ = rows(mesh.coordinates()) - rows(base);
    step_length_ = std::min(1.5 * step_length_, largest_step_length);
  }
  /// Rejects a step: the next one has to be shorter.
  void reject() { step_length_ *= 0.4; }

  /// True if steps have become too short to make progress.
  bool is_stuck() const { return step_length_ < min_step_length; }

 private:
  static constexpr double first_step_length = 0.2;  ///< in shortest edges: see scale_of_step
  static constexpr double largest_step_length = 0.6;
  static constexpr double min_step_length = 1e-4;
  static constexpr double max_movement = 0.2;  ///< of any node, in its shortest edge

  static Point<dim> row(const NodeVectors& vectors, std::size_t k) {
    return vectors.row(static_cast<Eigen::Index>(k)).transpose();
  }

  /// Returns a row for each moving node.
  NodeVectors rows(std::span<const Point<dim>> vectors) const {
    NodeVectors rows(nodes_.nodes().size(), dim);
    for (std::size_t k = 0; k < nodes_.nodes().size(); ++k)
      rows.row(static_cast<Eigen::Index>(k)) = vectors[nodes_.nodes()[k]].transpose();
    return rows;
  }

  /// Projects the movements of boundary nodes onto the boundary.
  void keep_along(NodeVectors& vectors) const {
    for (std::size_t k = 0; k < nodes_.nodes().size(); ++k)
      vectors.row(static_cast<Eigen::Index>(k)) =
          nodes_.along(nodes_.nodes()[k], row(vectors, k)).transpose();
  }

  static double shortest_edge(const Mesh<dim>& mesh, NodeIndex i) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const NodeIndex j : mesh.topology().node_neighbours(i))
      shortest = std::min(shortest, (mesh.coordinates()[j] - mesh.coordinates()[i]).norm());
    return shortest;
  }

  /// Returns the number that a fraction of all numbers are below.
  static double quantile(std::vector<double> numbers, double fraction) {
    const auto position = numbers.begin() + static_cast<std::ptrdiff_t>(
                                                fraction * static_cast<double>(numbers.size() - 1));
    std::nth_element(numbers.begin(), position, numbers.end());
    return *position;
  }

  /// Returns t such that 99 % of the movements t |z_i| are no longer than the step length times the
  /// shortest edge there. At most 1 if BFGS determines the length.
  double scale_of_step() const {
    std::vector<double> lengths;
    for (std::size_t k = 0; k < shortest_edges_.size(); ++k)
      lengths.push_back(row(direction_, k).norm() / shortest_edges_[k]);
    const double length = quantile(std::move(lengths), 0.99);
    const double scale = length > 0.0 ? step_length_ / length : 0.0;
    return memory_.empty() ? scale : std::min(1.0, scale);
  }

  const MovableNodes<dim>& nodes_;
  NodeLaplacian laplacian_;
  LimitedMemory memory_;
  double step_length_ = first_step_length;
  NodeVectors gradient_, direction_, last_step_;
  std::vector<double> shortest_edges_;  ///< shortest edge of each moving node
};

}  // namespace smoothfem
