// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// How far nodes may go on straight lines to new positions, all at the same pace, before a corner
/// of one of their cells has lost `fraction` of its determinant: limits[i] in (0, 1] is the
/// smallest of these fractions over the cells of node i, 1 where all may go through. In space the
/// fractions are lower bounds, which differ from the true ones by little. from, to: coordinates of
/// all nodes, valid at `from`; fraction in (0, 1). Nodes that stop at different fractions can still
/// make a cell invalid: look again from `from` to the shortened positions. Returns the smallest
/// limit.
template <int dim>
double feasible_fractions(const Topology& topology, std::span<const Point<dim>> from,
                          std::span<const Point<dim>> to, double fraction,
                          std::vector<double>& limits);

}  // namespace smoothfem
