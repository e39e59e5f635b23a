// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/elements/adaptive_quadrature.h"
#include "fem/solution_record.h"
#include "fem/solutions/manufactured_solution.h"
#include "fem/space/finite_element_space.h"

namespace smoothfem {

/// Errors of a finite element function u_h relative to the solution u that it approximates.
struct ErrorNorms {
  double e_max = 0.0;   ///< largest |u - u_h| at the free dofs
  double e_mean = 0.0;  ///< mean of |u - u_h| over the free dofs
  /// Norms of the finite element function I_h u - u_h, with the nodal interpolant I_h: e_L2 and
  /// e_H1 of the thesis. H1 is the full norm, values and gradients.
  double e_l2 = 0.0;
  double e_h1 = 0.0;
  /// Norms of u - u_h itself, by quadrature: the errors of textbooks.
  double l2_error = 0.0;
  double h1_error = 0.0;
  adaptive_quadrature::Use points;  ///< of this rank's hexahedra
};

/// Computes the errors. exact: u at all local dofs; discrete: u_h at all local dofs. x: coordinates
/// of the local nodes of a mesh without invalid cells. Collective; the same on all ranks.
template <int dim>
ErrorNorms error_norms(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
                       const ManufacturedSolution<dim>& solution, const Eigen::VectorXd& exact,
                       const Eigen::VectorXd& discrete);

/// Computes the errors of this rank's cells, in the order of the space's groups and of their cells.
/// Parameters: see error_norms. The sums of their squares are those of error_norms, apart from
/// rounding. Collective.
template <int dim>
std::vector<ErrorOnCell> cell_errors(const FiniteElementSpace<dim>& space,
                                     const std::vector<Point<dim>>& x,
                                     const ManufacturedSolution<dim>& solution,
                                     const Eigen::VectorXd& exact, const Eigen::VectorXd& discrete);

}  // namespace smoothfem
