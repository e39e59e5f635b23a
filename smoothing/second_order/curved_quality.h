// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/second_order/jacobian_bounds.h"

/// Quality of cells of second order. points, for all functions: the nodes of one cell, in the order
/// of midside_nodes.h. Bad numbers of points throw InputError.

namespace smoothfem {

/// Triangles and tetrahedra above this mean ratio are valid if their midside nodes are off the
/// middle of straight edges by rounding errors only: these change det J by less than it is.
inline constexpr double well_above_rounding_errors = 1e-3;

/// Mean ratio of a curved cell: as in mean_ratio.h, but with the tangents of the cell's edges at
/// each corner in place of its straight edges. They are the columns of the cell's Jacobian there.
/// All corners of a triangle or tetrahedron count, as they differ. In (0, 1] for cells that are
/// proven valid (jacobian_bounds.h), 0 for all others. For straight cells it is their mean ratio up
/// to rounding, or 0 if det J is not positive inside.
template <int dim>
double curved_mean_ratio(std::span<const Point<dim>> points);

/// Bounds of the scaled Jacobian min det J / max |det J|, in [-1, 1]: 1 for straight simplices, -1
/// for inverted ones. (Johnen et al., see jacobian_bounds.h; there max det J.) Their distance is
/// about `tolerance`, 0 or more, unless max_bisections are not enough. [-1, 1] if all numbers are
/// smaller than rounding errors, and for points that are not finite.
template <int dim>
Interval scaled_jacobian(std::span<const Point<dim>> points, double tolerance);

/// Area or volume of a curved cell, negative for inverted ones: the integral of det J. Exact up to
/// rounding.
template <int dim>
double curved_cell_size(std::span<const Point<dim>> points);

/// Returns the same for a cell of a mesh, relative to its target if the mesh has some.
template <int dim>
double curved_mean_ratio(const Mesh<dim>& mesh, CellIndex cell);

/// Returns the mean ratio of every cell, in the order of the cells: that of the curved cell if it
/// has midside nodes, otherwise cell_mean_ratio(). Both are relative to the targets if the mesh has
/// some. In surface meshes all cells count as straight ones. Does not depend on threads.
template <int dim, int spacedim>
std::vector<double> curved_mean_ratios(const Mesh<dim, spacedim>& mesh);

/// Returns the lower bound of every cell's scaled Jacobian, in the order of the cells. Linear cells
/// have their multilinear mapping. Polygons of five and more corners have no mapping: not a number.
/// Does not depend on threads.
template <int dim>
std::vector<double> scaled_jacobians(const Mesh<dim>& mesh, double tolerance = 1e-3);

/// Returns the area or volume of every cell, in the order of the cells, negative for inverted ones.
/// Does not depend on threads.
template <int dim>
std::vector<double> curved_cell_sizes(const Mesh<dim>& mesh);

}  // namespace smoothfem
