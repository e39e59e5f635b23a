// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "fem/solutions/manufactured_solution.h"
#include "fem/space/finite_element_space.h"
#include "smoothing/loop/problem.h"

namespace smoothfem {

/// A continuous gradient G, recovered from a finite element function u by averages at the nodes
/// (Zienkiewicz, Zhu 1987), and its difference from the function's gradient. u_1 is linear (like
/// the mapping) with the values of u at the nodes. G is linear with the means of grad u_1 in the
/// cells around the nodes.
///
/// For elements of degree 1 the difference estimates the error; for degree 2 it shows where u
/// bends. (Means of the gradient of degree 2 at the dofs are no better than that gradient. On
/// uniform quadrilaterals their error was the same, and the estimate was a hundredth of the error.)
/// With a diffusivity A, norms are those of the energy. In these the solution is the best
/// approximation. The recovery itself does not change; where A jumps, G averages over the jump. For
/// triangles, quadrilaterals, tetrahedra and hexahedra. Results for cells are ordered group after
/// group.
template <int dim>
class GradientRecovery {
 public:
  /// x: coordinates of the space's nodes; u: at its dofs; solution: provides A. All must outlive
  /// this.
  GradientRecovery(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
                   const Eigen::VectorXd& u, const ManufacturedSolution<dim>& solution);

  /// Returns the root of the mean over each cell of d . A d, where d = G - grad u_1.
  std::vector<double> differences() const;

  /// Returns the mean over each cell of (d . A d) d d^T / |d|^2. Its direction is that of the
  /// gradient's error, its trace the square of differences().
  std::vector<CellTensor<dim>> difference_tensors() const;

  /// Returns the mean over each cell of the symmetric part of grad G (second derivatives), times
  /// the root of the mean eigenvalue of A. That factor weighs errors in the energy norm.
  std::vector<CellTensor<dim>> hessians() const;

 private:
  /// Returns the mean of square(d, position) over each cell.
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
