// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/point.h"
#include "smoothing/second_order/shape_functions.h"
#include "smoothing/simd/lanes.h"

namespace smoothfem {

/// A point of a reference element (shape_functions.h) and its weight.
struct WeightedPoint {
  Point<3> x;
  double weight;
};

/// Returns a rule for integrals over the reference element with n_corners corners, relative to its
/// size: positive weights with the sum 1. dim: 2 or 3. It is exact for polynomials of degree 3. All
/// corners are points of it, where a cell of second order first becomes invalid, except the apex of
/// a pyramid, where gradients have no value.
///
///   triangle        corners, middles of sides, centre
///   quadrilateral   Simpson's rule in both directions
///   tetrahedron     corners, centres of faces
///   pyramid         Simpson's rule in (x, y) / (1-z), Radau's rule in z for the weight (1-z)^2
///   prism           the triangle's rule, times Simpson's
///   hexahedron      Simpson's rule in all directions
std::vector<WeightedPoint> reference_rule(int dim, std::size_t n_corners);

/// Weights of a cell's points and gradients of its shape functions there, by coordinates in which
/// the ideal cell of its type is the reference domain. With nodes x_i, S = sum_i x_i grad N_i' is
/// the Jacobian of the mapping from the ideal cell: S = J W^-1. S of straight regular cells is a
/// rotation times a number at all points.
///
/// Cells of second order: the points of reference_rule(). Linear cells and polygons: the corners
/// that the mean ratio counts, with equal weights, and W of mean_ratio.h.
template <int dim>
class CellRule {
 public:
  CellRule(std::size_t n_corners, std::size_t n_midside);

  std::size_t n_nodes() const { return n_nodes_; }
  /// Number of groups of n_lanes points. In the last one, points of weight 0 fill up the lanes.
  std::size_t n_groups() const { return weights_.size() / n_lanes; }
  Lanes weights(std::size_t group) const { return load_lanes(&weights_[n_lanes * group]); }
  /// Returns component d of a node's gradients at the points of a group.
  Lanes gradient(std::size_t group, std::size_t node, std::size_t d) const {
    return load_lanes(&gradients_[n_lanes * ((group * n_nodes_ + node) * dim + d)]);
  }

  /// Returns the mean of a node's gradients. Mean of S: sum_i x_i mean_gradient(i)'.
  const Point<dim>& mean_gradient(std::size_t node) const { return mean_gradients_[node]; }
  /// Returns the factor of x_p . x_q in the mean of |S - S'|^2, for cells of second order. S' is
  /// the Jacobian of the straight cell: midside nodes are in the mean of the corners of their edge,
  /// face or cell.
  double bending(std::size_t p, std::size_t q) const { return bending_[p * n_nodes_ + q]; }

 private:
  void add_point(double weight, const std::vector<Point<dim>>& gradients);
  void fill_group();
  void set_bending(std::size_t n_corners);

  std::size_t n_nodes_, n_points_ = 0;
  std::vector<double> weights_, gradients_;
  std::vector<Point<dim>> mean_gradients_;
  std::vector<double> bending_;
};

}  // namespace smoothfem
