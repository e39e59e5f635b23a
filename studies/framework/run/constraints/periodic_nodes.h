// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/constraints/node_ties.h"
#include "fem/solutions/manufactured_solution.h"

namespace smoothfem {

/// Returns the number of nodes with a periodic partner.
std::size_t n_periodic_nodes(const Topology& topology);

/// Ties nodes to their periodic partners. Boundary facets whose partners are boundary facets, too,
/// are no boundary any more. Throws InputError if no other boundary remains.
NodeTies periodic_ties(const Topology& topology);

/// Throws InputError that names the first pair of periodic partners where u or its gradient
/// differs. Partners that are not moved images of each other need the same u only.
template <int dim>
void require_periodic(const ManufacturedSolution<dim>& solution, const Mesh<dim>& mesh);

}  // namespace smoothfem
