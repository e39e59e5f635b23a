// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "fem/solutions/manufactured_solution.h"
#include "fem/space/finite_element_space.h"

namespace smoothfem {

/// Error indicators of the solution u of -div(A grad u) = f from its residual (Kelly, Gago,
/// Zienkiewicz, Babuska 1983): of each cell K, group after group,
///   a_K eta_K^2 = h_K^2 |f + div(A grad u)|^2_K
///                 + 1/2 sum of h_F |[A grad u . n]|^2_F over its inner facets F,
/// norms those of L2, h diameters, a_K the mean of A's eigenvalues at the dofs (Bernardi, Verfürth
/// 2000), and the indicator eta_K / sqrt(|K|), which is a mean over the cell as that of a recovery
/// is. On triangles, quadrilaterals, tetrahedra and hexahedra of degree 1 or 2. A grad u between
/// the dofs is its interpolant: where A is constant exact on simplices and parallelepipeds, as are
/// the integrals over facets (by their dofs) but those of degree 1 on quadrilaterals and hexahedra,
/// which are a little large. Boundary facets count nothing. x: coordinates of the space's nodes, u:
/// at its dofs. The same bits for every number of threads.
template <int dim>
std::vector<double> residual_indicators(const FiniteElementSpace<dim>& space,
                                        const std::vector<Point<dim>>& x, const Eigen::VectorXd& u,
                                        const ManufacturedSolution<dim>& solution);

}  // namespace smoothfem
