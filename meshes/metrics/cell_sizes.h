// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Returns Verdict's relative size squared of each cell, min(s / m, m / s)^2 in [0, 1]. s is the
/// cell's area or volume, m the mean over the mesh's cells of the same type, without signs. 0 for
/// cells that are turned over or have no size.
template <int dim, int spacedim>
std::vector<double> relative_sizes_squared(const Mesh<dim, spacedim>& mesh);

/// Returns the size gradation of each cell: the largest ratio, at least 1, of its area or volume to
/// that of a cell with a common facet, or the inverse. Without signs; infinite (see metric.h) next
/// to a cell without size. NaN for cells without such a neighbour.
template <int dim, int spacedim>
std::vector<double> size_gradations(const Mesh<dim, spacedim>& mesh);

}  // namespace smoothfem
