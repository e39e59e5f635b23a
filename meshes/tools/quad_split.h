// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "meshes/tools/mesh_cells.h"

namespace smoothfem {

/// The corner of a quadrilateral, 0 or higher, at which the cutting diagonal starts; or nothing.
using Diagonal = std::optional<std::size_t>;

/// Cuts cells, all of them quadrilaterals, into two triangles. diagonals: one for each cell.
void cut_quadrilaterals(PlanarCells& mesh, const std::vector<Diagonal>& diagonals);
/// Cuts the quadrilaterals that are not convex, so that both triangles are valid.
void cut_invalid_quadrilaterals(PlanarCells& mesh);
/// Cuts the n quadrilaterals with the lowest mean ratio, or all if there are fewer, at their
/// shorter diagonal. All must be convex.
void cut_worst_quadrilaterals(PlanarCells& mesh, std::size_t n);

/// Splits every cell into quadrilaterals by its edges' midpoints and its centre: a triangle gives
/// three, a quadrilateral four (six if it is not convex). boundary_midpoint(a, b), if not empty,
/// returns the midpoint's position on the boundary edge between nodes a and b (a before b in its
/// cell).
PlanarCells split_to_quadrilaterals(
    const PlanarCells& mesh,
    const std::function<Point<2>(NodeIndex, NodeIndex)>& boundary_midpoint = {});

}  // namespace smoothfem
