// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Dense>
#include <span>

#include "smoothing/mesh/point.h"
#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// Free nodes that slide on the boundary of a mesh; interface for descent methods. May be used by
/// several threads at a time.
template <int dim>
class SlidingNodes {
 public:
  virtual ~SlidingNodes() = default;

  /// Returns the number of directions in which the node may move: dim if it moves freely, 1 on a
  /// line, 2 on a surface.
  virtual int n_directions(NodeIndex node) const = 0;
  /// Returns the position of a node that is at `from` and should move to `wanted`.
  virtual Point<dim> project(NodeIndex node, const Point<dim>& from,
                             const Point<dim>& wanted) const = 0;
  /// True if the facets around the node keep their distance from the initial boundary. x: of all
  /// nodes.
  virtual bool keeps_bound(std::span<const Point<dim>> x, NodeIndex node) const = 0;
};

/// Returns the directions in which a node slides, as orthonormal columns. They come from
/// projections of points at `distance` from the node. So a kink of the boundary at the node counts
/// as a mean of its surroundings.
template <int dim>
Eigen::Matrix<double, dim, Eigen::Dynamic, 0, dim, dim> sliding_directions(
    const SlidingNodes<dim>& sliding, NodeIndex node, const Point<dim>& position, double distance) {
  Eigen::Matrix<double, dim, dim> projections;
  for (int d = 0; d < dim; ++d) {
    const Point<dim> offset = distance * Point<dim>::Unit(d);
    projections.col(d) = sliding.project(node, position, Point<dim>(position + offset)) -
                         sliding.project(node, position, Point<dim>(position - offset));
  }
  const Eigen::Matrix<double, dim, dim> symmetric = projections + projections.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, dim, dim>> solver(symmetric);
  return solver.eigenvectors().rightCols(sliding.n_directions(node));  // eigenvalues are ascending
}

}  // namespace smoothfem
