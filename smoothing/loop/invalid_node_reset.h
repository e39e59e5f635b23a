// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <type_traits>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Puts the nodes of invalid cells, and of facets beyond the bound that the mesh has for them, back
/// to where they were, again and again until there is none (thesis, Fig. 4.2,
/// IterativeInvalidElementResetting). cell_quality: of mesh, kept up to date. Ends with a valid
/// mesh that keeps the bound if `previous` is one. least_quality: cells below it are put back, too.
/// Returns the nodes that were put back.
template <int dim, int spacedim>
std::vector<NodeIndex> reset_nodes_of_invalid_cells(
    Mesh<dim, spacedim>& mesh, std::type_identity_t<std::span<const Point<spacedim>>> previous,
    std::vector<double>& cell_quality, double least_quality = 0.0);

}  // namespace smoothfem
