#pragma once

#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// How far nodes may go on straight lines to new places, all at the same pace, before a corner of
/// one of their cells has lost `share` of its determinant: limits[i] in (0, 1] is the smallest of
/// these fractions over the cells of node i, 1 where all may go through. In space the fractions are
/// lower bounds, which differ from the true ones by little. from, to: places of all nodes, valid at
/// `from`; share in (0, 1). Nodes that stop at different fractions can still make a cell invalid:
/// look again from `from` to the shortened places. Returns the smallest limit.
template <int dim>
double feasible_fractions(const Topology& topology, const std::vector<Point<dim>>& from,
                          const std::vector<Point<dim>>& to, double share,
                          std::vector<double>& limits);

}  // namespace smoothfem
