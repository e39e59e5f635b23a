// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "fem/assembly/load.h"
#include "fem/elements/adaptive_quadrature.h"
#include "fem/solutions/manufactured_solution.h"
#include "fem/space/finite_element_space.h"

namespace smoothfem {

inline constexpr std::size_t no_cell = UINT32_MAX;

/// The linear system of the Poisson problem for this rank's free dofs; boundary values are
/// eliminated.
struct PoissonSystem {
  SparseMatrix matrix;              ///< symmetric positive definite, with the space's pattern
  Eigen::VectorXd right_hand_side;  ///< n_own
  Eigen::VectorXd exact;  ///< u at all local dofs; the boundary values at dofs that are not free
  /// Cells of this rank whose mapping is folded at a quadrature point. A hexahedron can be valid at
  /// all corners and folded inside; the matrix may then be indefinite.
  std::size_t n_folded_cells = 0;
  std::size_t first_folded_cell = no_cell;  ///< by its number in the mesh
  adaptive_quadrature::Use points{};        ///< of this rank's hexahedra
};

/// Makes a system with the space's pattern, to be filled repeatedly.
template <int dim>
PoissonSystem make_system(const FiniteElementSpace<dim>& space);

/// Returns the material of each kind of cells, on all ranks; empty if A and f are functions of the
/// position. Collective.
template <int dim>
std::vector<std::uint32_t> materials_of_kinds(const Ranks& ranks,
                                              const ManufacturedSolution<dim>& solution);

/// Fills the system for a mesh whose cells are all valid. x: coordinates of the local points. In a
/// curved space, throws CellError on all ranks for the first cell that is folded inside.
/// Collective.
template <int dim>
void assemble(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
              const ManufacturedSolution<dim>& solution, Load load, PoissonSystem& system);

}  // namespace smoothfem
