// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <set>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Thin cells along the boundary, as solvers need them at walls.
struct Layers {
  std::vector<CellIndex> cells;  ///< ascending
  std::set<int> tags;            ///< of the boundary facets that they lie on; 0: no label
};

/// Ratio from which a cell is thin.
inline constexpr double min_layer_aspect = 10.0;

/// Returns the longest edge of a cell over its height above its largest facet; infinity for cells
/// without volume. 1 for squares and cubes.
template <int dim>
double cell_aspect(const Mesh<dim>& mesh, CellIndex cell);

/// Returns the thin cells that stand upright with one of their largest facets on the boundary, and
/// thin cells that facets connect with them through other thin cells. On a tenth of the facets with
/// a label at least there must be such a cell. tags: labels of the boundary facets to begin at;
/// empty: all.
template <int dim>
Layers find_layers(const Mesh<dim>& mesh, const std::set<int>& tags = {});

}  // namespace smoothfem
