// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/solutions/manufactured_solution.h"

namespace smoothfem {

/// A solution in pieces solves -div(A grad u) = f only if u and A grad u . n go on from piece to
/// piece: otherwise f would need a part on the line or surface between them. Looks where edges of
/// the mesh cross from one to another, and throws InputError that names the first point where one
/// of the two jumps.
template <int dim>
void check_pieces(const ManufacturedSolution<dim>& solution, const Mesh<dim>& mesh);

}  // namespace smoothfem
