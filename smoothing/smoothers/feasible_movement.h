#pragma once

#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// How far nodes may go on straight lines to new places, all at the same pace, before a corner of
/// one of their cells has lost `share` of its determinant: limits[i] in (0, 1] is the smallest of
/// these fractions over the cells of node i, 1 where all may go through. from, to: places of all
/// nodes, valid at `from`; share in (0, 1). Nodes that stop at different fractions can still make a
/// cell invalid: look again from `from` to the shortened places. Returns the smallest limit.
double feasible_fractions(const Topology& topology, const std::vector<Point<2>>& from,
                          const std::vector<Point<2>>& to, double share,
                          std::vector<double>& limits);

}  // namespace smoothfem
