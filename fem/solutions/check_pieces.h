// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/solutions/manufactured_solution.h"

namespace smoothfem {

/// Checks that u and the normal flux A grad u . n are continuous across interfaces between pieces
/// of a solution. Otherwise f would need a part on the interface. Checks edges of the mesh that
/// cross from one piece to another. Throws InputError that names the first point where u or the
/// flux jumps.
template <int dim>
void check_pieces(const ManufacturedSolution<dim>& solution, const Mesh<dim>& mesh);

}  // namespace smoothfem
