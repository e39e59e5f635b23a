// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/space/finite_element_space.h"
#include "fem/space/natural_boundary.h"

namespace smoothfem {

/// Checks a mesh like require_finite_elements, but collectively: only the root sees errors of a
/// mesh, but all ranks have to stop; otherwise the others would wait forever. topology: null
/// elsewhere, or each rank's part.
template <int dim>
void require_on_all_ranks(const Topology* topology, int degree,
                          const std::vector<std::string>& natural_groups, const Ranks& ranks);

/// Fills the parts of a space that deal.II knows, from its degree and ranks: the numbers of dofs,
/// the cells with their dofs and nodes (not their coordinates), the nodes, the columns' numbers and
/// the halo. Parameters and errors: see make_finite_element_space. Returns the boundary with
/// natural conditions. Collective.
template <int dim>
NaturalBoundary number_dofs(const Mesh<dim>* mesh, const TensorPoints& tensor_points,
                            const std::vector<std::string>& natural_groups, const NodeTies* ties,
                            FiniteElementSpace<dim>& space);

}  // namespace smoothfem
