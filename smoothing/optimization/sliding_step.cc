// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/optimization/sliding_step.h"

#include <Eigen/Dense>

#include "smoothing/optimization/node_objective.h"

namespace smoothfem {

namespace {

/// Mean distance of a node from the other nodes of its cells.
template <int dim>
double mean_distance(const Topology& topology, NodeIndex node, std::span<const Point<dim>> x) {
  double sum = 0.0, n = 0.0;
  for (const CellIndex c : topology.node_cells(node))
    for (const NodeIndex other : topology.cell_nodes(c)) {
      if (other == node) continue;
      sum += (x[other] - x[node]).norm();
      n += 1.0;
    }
  return sum / n;
}

/// Returns the directions in which a constrained node may move, as orthonormal columns. They come
/// from projections of points at `distance` from the node. So a kink of the boundary at the node
/// counts as a mean of its surroundings.
template <int dim>
Eigen::Matrix<double, dim, Eigen::Dynamic, 0, dim, dim> sliding_directions(
    const NodeConstraints<dim>& constraints, NodeIndex node, const Point<dim>& position,
    double distance) {
  Eigen::Matrix<double, dim, dim> projections;
  for (int d = 0; d < dim; ++d) {
    const Point<dim> offset = distance * Point<dim>::Unit(d);
    projections.col(d) = constraints.project(node, position, Point<dim>(position + offset)) -
                         constraints.project(node, position, Point<dim>(position - offset));
  }
  const Eigen::Matrix<double, dim, dim> symmetric = projections + projections.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, dim, dim>> solver(symmetric);
  return solver.eigenvectors().rightCols(
      constraints.classifications()[node].n_directions(dim));  // eigenvalues are ascending
}

}  // namespace

template <int dim>
void slide_node(const Topology& topology, const NodeConstraints<dim>& constraints, NodeIndex node,
                double softness, std::span<Point<dim>> x) {
  constexpr double sufficient = 1e-4, probe = 0.05;
  constexpr int max_halvings = 12, max_out_of_bound = 2;  // the bound costs more than the cells
  const double distance = mean_distance<dim>(topology, node, x);
  if (!(distance > 0.0)) return;
  if (softness > 0.0) softness *= mean_size<dim>(topology, x, node);
  const Point<dim> start = x[node];
  const auto directions = sliding_directions(constraints, node, start, probe * distance);
  const auto here = local_objective<true, dim>(topology, x, node, start, softness);
  const Eigen::VectorXd gradient = directions.transpose() * here.gradient;
  const Eigen::MatrixXd hessian = directions.transpose() * here.hessian * directions;
  Point<dim> step = -(directions * hessian.ldlt().solve(gradient));
  if (!step.allFinite()) return;
  if (step.norm() > distance) step *= distance / step.norm();
  const double slope = step.dot(here.gradient);
  if (!(slope < 0.0)) return;
  double alpha = 1.0;
  for (int k = 0, n_out = 0; k < max_halvings && n_out < max_out_of_bound; ++k, alpha *= 0.5) {
    const Point<dim> trial = constraints.project(node, start, Point<dim>(start + alpha * step));
    const double value = local_objective<false, dim>(topology, x, node, trial, softness).value;
    if (!(value <= here.value + sufficient * alpha * slope)) continue;
    x[node] = trial;
    if (constraints.keeps_bound(x, {&node, 1})) return;
    x[node] = start;
    ++n_out;
  }
}

template void slide_node<2>(const Topology&, const NodeConstraints<2>&, NodeIndex, double,
                            std::span<Point<2>>);
template void slide_node<3>(const Topology&, const NodeConstraints<3>&, NodeIndex, double,
                            std::span<Point<3>>);

}  // namespace smoothfem
