// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "distributed/scattered_mesh.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Moves cells between ranks until each has about as many as any other. Cells that lie near each
/// other come to the same rank: Zoltan bisects the mesh by coordinates, recursively. Cells stay
/// where they are if no rank has more than 1.05 times its share. Collective.
/// Throws InputError on all ranks if these are more than the cells.
template <int dim>
ScatteredMesh<dim> balanced(const Ranks& ranks, ScatteredMesh<dim> mesh);

/// Returns the part of each cell of a whole mesh, from 0 to n_parts - 1. Parts have about equal
/// numbers of cells.
template <int dim>
std::vector<int> bisected_cells(const Mesh<dim>& mesh, int n_parts);

}  // namespace smoothfem
