// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/dofs/dof_handler.h>

// Includes deal.II's headers: for sources of this folder only.

namespace smoothfem {

/// Makes Lagrange elements of a degree on a triangulation of make_triangulation. Dofs are numbered
/// in the order of cells in planar meshes, part by part in volume meshes (see FiniteElementSpace).
/// Collective.
template <int dim>
void distribute_dofs(dealii::DoFHandler<dim>& dofs, int degree);

}  // namespace smoothfem
