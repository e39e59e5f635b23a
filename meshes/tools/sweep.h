// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "meshes/tools/mesh_cells.h"

namespace smoothfem {

/// Sweeps quadrilaterals along z: cell c of the base becomes a column of n_layers(c) hexahedra, the
/// first between heights[0] and heights[1]. base: quadrilaterals only, counterclockwise. heights:
/// ascending. n_layers: from 1 to heights.size() - 1; where neighbours differ, the solid has a
/// step. Nodes and cells are ordered level by level, and in a level as in the base.
VolumeCells sweep(const PlanarCells& base, const std::vector<double>& heights,
                  const std::function<std::size_t(CellIndex)>& n_layers);

/// Returns heights from 0 to `height` in equal steps. Their number is the integer nearest to
/// n_layers, at least one.
std::vector<double> equal_layers(double height, double n_layers);

/// Sweeps each cell through all heights.
VolumeCells sweep(const PlanarCells& base, const std::vector<double>& heights);

}  // namespace smoothfem
