// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "fem/solutions/manufactured_solution.h"
#include "fem/space/finite_element_space.h"

namespace smoothfem {

/// Returns error indicators of the solution u of -div(A grad u) = f from its residual (Kelly, Gago,
/// Zienkiewicz, Babuska 1983). For each cell K, group after group:
///
///   a_K eta_K^2 = h_K^2 |f + div(A grad u)|^2_K
///                 + 1/2 sum of h_F |[A grad u . n]|^2_F over its inner facets F
///
/// Norms are those of L2, h are diameters, and a_K is the mean of A's eigenvalues at the dofs
/// (Bernardi, Verfürth 2000). The indicator is eta_K / sqrt(|K|), a mean over the cell like that of
/// a recovery.
///
/// For triangles, quadrilaterals, tetrahedra and hexahedra of degree 1 or 2. A grad u between the
/// dofs is its interpolant, which is exact on simplices and parallelepipeds if A is constant.
/// Integrals over facets (by their dofs) are then exact, too, except for degree 1 on quadrilaterals
/// and hexahedra, where they are slightly too large. Boundary facets do not count. x: coordinates
/// of the space's nodes, u: at its dofs. Results are bitwise identical for every number of threads.
template <int dim>
std::vector<double> residual_indicators(const FiniteElementSpace<dim>& space,
                                        const std::vector<Point<dim>>& x, const Eigen::VectorXd& u,
                                        const ManufacturedSolution<dim>& solution);

}  // namespace smoothfem
