// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "fem/elements/chosen_points.h"
#include "fem/solutions/manufactured_solution.h"
#include "fem/space/finite_element_space.h"

namespace smoothfem {

/// Errors of a finite element function u_h against the solution u it approximates.
struct ErrorNorms {
  double e_max = 0.0;   ///< largest |u - u_h| at the free dofs
  double e_mean = 0.0;  ///< mean of |u - u_h| over the free dofs
  /// Norms of the finite element function I_h u - u_h, I_h the nodal interpolant: what the thesis
  /// prints as e_L2 and e_H1. H1 is the full norm, values and gradients.
  double e_l2 = 0.0;
  double e_h1 = 0.0;
  /// Norms of u - u_h itself, by quadrature: the textbook's errors.
  double l2_error = 0.0;
  double h1_error = 0.0;
  chosen_points::Use points;  ///< of this rank's hexahedra
};

/// exact: u at all local dofs; discrete: u_h at all local dofs. x: coordinates of the local nodes
/// of a mesh without invalid cells. Collective; the same on all ranks.
template <int dim>
ErrorNorms error_norms(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
                       const ManufacturedSolution<dim>& solution, const Eigen::VectorXd& exact,
                       const Eigen::VectorXd& discrete);

}  // namespace smoothfem
