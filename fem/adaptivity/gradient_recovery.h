// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "fem/solutions/manufactured_solution.h"
#include "fem/space/finite_element_space.h"
#include "smoothing/loop/problem.h"

namespace smoothfem {

/// A continuous gradient G that is recovered from a finite element function u by averages at the
/// nodes (Zienkiewicz, Zhu 1987), and what the difference tells. u_1 is linear (as the mapping is)
/// with the values of u at the nodes, G the same with the means of grad u_1 in the cells around the
/// nodes. With elements of degree 1 the difference is an estimate of the error; with those of
/// degree 2 it says where u bends. (Means at the dofs of the gradient of degree 2 itself are no
/// better than it is: on even quadrilaterals they err as it does, and the estimate was a hundredth
/// of the error.) Where there is a diffusivity A sizes are those of the energy norm, in which the
/// solution is the best; the gradient is recovered all the same, and where A jumps G averages over
/// the jump. On triangles, quadrilaterals, tetrahedra and hexahedra; what is said of cells
/// runs group after group.
template <int dim>
class GradientRecovery {
 public:
  /// x: coordinates of the space's nodes, u: at its dofs; of the solution A is taken. All have to
  /// outlive this.
  GradientRecovery(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
                   const Eigen::VectorXd& u, const ManufacturedSolution<dim>& solution);

  /// Root of the mean over each cell of d . A d, where d = G - grad u_1.
  std::vector<double> differences() const;

  /// Mean over each cell of (d . A d) d d^T / |d|^2: the direction is that in which the gradient
  /// errs, the trace is the square of differences().
  std::vector<CellTensor<dim>> difference_tensors() const;

  /// Mean over each cell of the symmetric part of grad G, second derivatives, times the root of the
  /// mean eigenvalue of A, by which errors there count in the energy norm.
  std::vector<CellTensor<dim>> hessians() const;

 private:
  /// Mean of square(d, position) over each cell.
  template <class Value, class Square>
  std::vector<Value> mean_squares(const Value& zero, const Square& square) const;

  const FiniteElementSpace<dim>& space_;
  const std::vector<Point<dim>>& x_;
  const Eigen::VectorXd& u_;
  const ManufacturedSolution<dim>& solution_;
  std::vector<Point<dim>> recovered_;  ///< G at each node
  std::vector<double> sizes_;          ///< of the cells
};

}  // namespace smoothfem
