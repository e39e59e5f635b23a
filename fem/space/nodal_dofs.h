// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/space/finite_element_space.h"
#include "fem/space/natural_boundary.h"

namespace smoothfem {

/// Does the same as number_dofs, for elements of degree 1 on meshes of any types of cells: dofs are
/// nodes. topology, ties: on the root, null elsewhere; ties may be null there, too. Several ranks
/// get parts with about as many cells; the parts follow each other in a walk over neighbours. If
/// each rank already has its part of the mesh, own dofs are its own nodes, in their order.
/// Collective.
template <int dim>
void number_nodal_dofs(const Topology* topology, const TensorPoints& tensor_points,
                       const NaturalBoundary& natural, const NodeTies* ties,
                       FiniteElementSpace<dim>& space);

}  // namespace smoothfem
