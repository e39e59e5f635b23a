// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/finite_element_space.h"

namespace smoothfem {

/// Fills what deal.II knows of a space, from its degree and ranks: the numbers of dofs, the cells
/// with their dofs and nodes (not their coordinates), the nodes, the columns' numbers and the halo.
/// Parameters and errors: see make_finite_element_space. Collective.
template <int dim>
void number_dofs(const Mesh<dim>* mesh, const TensorPoints& tensor_points,
                 FiniteElementSpace<dim>& space);

}  // namespace smoothfem
