// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "fem/finite_element_space.h"
#include "smoothing/loop/problem.h"

namespace smoothfem {

/// A continuous gradient G that is recovered from a finite element function u by averages at the
/// nodes (Zienkiewicz, Zhu 1987), and what the difference tells. u_1 is linear (as the mapping is)
/// with the values of u at the nodes, G the same with the means of grad u_1 in the cells around the
/// nodes. With elements of degree 1 the difference is an estimate of the error; with those of
/// degree 2 it says where u bends. (Means at the dofs of the gradient of degree 2 itself are no
/// better than it is: on even quadrilaterals they err as it does, and the estimate was a hundredth
/// of the error.) On triangles, quadrilaterals, tetrahedra and hexahedra; what is said of cells
/// runs group after group.
template <int dim>
class GradientRecovery {
 public:
  /// x: coordinates of the space's nodes, u: at its dofs; both have to outlive this.
  GradientRecovery(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
                   const Eigen::VectorXd& u);

  /// Root mean square over each cell of G - grad u_1.
  std::vector<double> differences() const;

  /// Mean over each cell of (G - grad u_1)(G - grad u_1)^T.
  std::vector<CellTensor<dim>> difference_tensors() const;

  /// Mean over each cell of the symmetric part of grad G: second derivatives.
  std::vector<CellTensor<dim>> hessians() const;

 private:
  /// Mean of square(G - grad u_1) over each cell.
  template <class Square>
  auto mean_squares(const Square& square) const;

  const FiniteElementSpace<dim>& space_;
  const std::vector<Point<dim>>& x_;
  const Eigen::VectorXd& u_;
  std::vector<Point<dim>> recovered_;  ///< G at each node
  std::vector<double> sizes_;          ///< of the cells
};

}  // namespace smoothfem
