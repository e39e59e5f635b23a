// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Verdict's relative size squared of each cell, min(s / m, m / s)^2 in [0, 1]: s is its area or
/// volume, m the mean of those of the mesh's cells of the same type, without their signs. 0 for
/// cells that are turned over or have no size.
template <int dim, int spacedim>
std::vector<double> relative_sizes_squared(const Mesh<dim, spacedim>& mesh);

/// How abruptly sizes change: the largest ratio, at least 1, of a cell's area or volume to that of
/// a cell with which it has a facet in common, or the other way round. Without signs; infinite (see
/// metric.h) beside nothing. NaN for cells without such a neighbour.
template <int dim, int spacedim>
std::vector<double> size_gradations(const Mesh<dim, spacedim>& mesh);

}  // namespace smoothfem
