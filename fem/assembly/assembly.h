// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "fem/elements/chosen_points.h"
#include "fem/solutions/manufactured_solution.h"
#include "fem/space/finite_element_space.h"

namespace smoothfem {

/// How the right-hand side b comes from f.
enum class Load {
  nodal,       ///< b = M f_h, f_h the nodal interpolant of f: what the thesis prints
  quadrature,  ///< b_i = integral of f phi_i: the textbook's Galerkin load
  none         ///< f is left out: for whoever adds it
};

/// The Poisson problem's linear system for this rank's free dofs; boundary values are eliminated.
struct PoissonSystem {
  SparseMatrix matrix;              ///< the pattern's: of a symmetric positive definite matrix
  Eigen::VectorXd right_hand_side;  ///< n_own
  Eigen::VectorXd exact;            ///< u at all local dofs; where they are not free, the boundary
                                    ///< values
  /// Cells of this rank whose mapping is folded at a quadrature point: the corners of a hexahedron
  /// may all be fine while its inside is not, and then the matrix may be indefinite.
  std::size_t n_folded_cells = 0;
  chosen_points::Use points{};  ///< of this rank's hexahedra
};

/// A system with the space's pattern, to be filled again and again.
template <int dim>
PoissonSystem make_system(const FiniteElementSpace<dim>& space);

/// Fills the system for a mesh whose cells are all valid. x: coordinates of the local nodes.
template <int dim>
void assemble(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
              const ManufacturedSolution<dim>& solution, Load load, PoissonSystem& system);

}  // namespace smoothfem
