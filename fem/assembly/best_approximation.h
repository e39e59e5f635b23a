// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/assembly/assembly.h"

namespace smoothfem {

/// Norm in which an approximation is the best one.
enum class Norm { l2, h1 };

/// Fills the system of the best approximation to u: of the finite element function with the
/// boundary values of u_h that is closest to u in the norm. It is the projection of u. Parameters:
/// see assemble. Collective.
template <int dim>
void assemble_projection(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
                         const ManufacturedSolution<dim>& solution, Norm norm,
                         PoissonSystem& system);

}  // namespace smoothfem
