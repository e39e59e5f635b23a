// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Dense>
#include <span>

#include "smoothing/mesh/point.h"
#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// Free nodes of a mesh's boundary that slide on it, as descent methods see them. Any number of
/// threads may ask at a time.
template <int dim>
class SlidingNodes {
 public:
  virtual ~SlidingNodes() = default;

  /// In how many directions the node may go: dim if it moves freely, 1 on a line, 2 on a surface.
  virtual int n_directions(NodeIndex node) const = 0;
  /// Where a node that is at `from` and should go to `wanted` comes to lie.
  virtual Point<dim> project(NodeIndex node, const Point<dim>& from,
                             const Point<dim>& wanted) const = 0;
  /// True if the facets around the node keep within their distance of the initial boundary. x: of
  /// all nodes.
  virtual bool keeps_bound(std::span<const Point<dim>> x, NodeIndex node) const = 0;
};

/// The directions in which a node slides, orthonormal columns: where projections go to of points
/// that lie `distance` off the node, so that a kink of the boundary at the node counts as a mean of
/// what is round it.
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
  return solver.eigenvectors().rightCols(sliding.n_directions(node));  // ascending eigenvalues
}

}  // namespace smoothfem
