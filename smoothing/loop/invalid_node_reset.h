// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <type_traits>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Resets the nodes of invalid cells, and of facets beyond the bound of the mesh, to their previous
/// positions until none is left (thesis, Fig. 4.2, IterativeInvalidElementResetting). cell_quality:
/// of `mesh`, kept up to date. Ends with a valid mesh within the bound if `previous` is one.
/// min_quality: nodes of cells below it are reset, too. Returns the nodes that were reset. In a
/// part of a mesh it returns those of the part, and is collective.
template <int dim, int spacedim>
std::vector<NodeIndex> reset_nodes_of_invalid_cells(
    Mesh<dim, spacedim>& mesh, std::type_identity_t<std::span<const Point<spacedim>>> previous,
    std::vector<double>& cell_quality, double min_quality = 0.0);

}  // namespace smoothfem
