// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/solutions/manufactured_solution.h"

namespace smoothfem {

/// Returns the solution with its materials assigned to the cells of a mesh by their groups. If
/// positions tell the materials, a group has that of its cells' positions. mesh: the initial one;
/// the result is for all meshes with its topology.
///
/// Throws InputError for a group that no cell has, for a cell in groups of two materials, and for a
/// group with cells on both sides of an interface. Throws it also if A or f of a material are not
/// finite there (see check_solution), and if u or the normal flux jumps between two materials.
template <int dim>
ManufacturedSolution<dim> with_materials_of(ManufacturedSolution<dim> solution,
                                            const Mesh<dim>& mesh);

/// Returns a point of a cell that is hardly moved towards the mean of its nodes. So it lies on the
/// cell's side of an interface.
template <int dim>
Point<dim> slightly_inside(const Point<dim>& point, const Point<dim>& mean) {
  constexpr double share = 1e-6;
  return point + share * (mean - point);
}

}  // namespace smoothfem
