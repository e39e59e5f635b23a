// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Limits the movement of nodes on straight lines to new positions, all at the same pace. Each
/// corner of a cell may lose at most `fraction` of its determinant. limits[i] in (0, 1] is the
/// smallest allowed part of the way over the cells of node i; 1 allows all of it. In space the
/// limits are slightly lower bounds. from, to: coordinates of all nodes, valid at `from`; fraction
/// in (0, 1). Nodes that stop at different parts of their way can still make a cell invalid: call
/// this again from `from` to the shortened positions. Returns the smallest limit.
template <int dim>
double feasible_fractions(const Topology& topology, std::span<const Point<dim>> from,
                          std::span<const Point<dim>> to, double fraction,
                          std::vector<double>& limits);

}  // namespace smoothfem
