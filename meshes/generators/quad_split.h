#pragma once

#include <functional>

#include "meshes/generators/gmsh_planar.h"

namespace smoothfem {

/// Splits every cell into quadrilaterals by its edges' midpoints and its centre: a triangle gives
/// three, a quadrilateral four (one that is not convex six). boundary_midpoint(a, b), if given,
/// says where the midpoint of the boundary edge between nodes a and b lies (a before b in its
/// cell).
PlanarCells split_to_quadrilaterals(
    const PlanarCells& mesh,
    const std::function<Point<2>(NodeIndex, NodeIndex)>& boundary_midpoint = {});

}  // namespace smoothfem
