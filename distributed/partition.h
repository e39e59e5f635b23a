// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "distributed/scattered_mesh.h"

namespace smoothfem {

/// Moves cells between ranks until each has about as many as any other. Cells that lie near each
/// other come to the same rank: Zoltan bisects the mesh by coordinates, recursively. Cells stay
/// where they are if no rank has more than 1.05 times its share. Collective.
template <int dim>
ScatteredMesh<dim> balanced(const Ranks& ranks, ScatteredMesh<dim> mesh);

}  // namespace smoothfem
