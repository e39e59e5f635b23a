// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "fem/solutions/manufactured_solution.h"
#include "fem/space/curved_points.h"
#include "fem/space/finite_element_space.h"
#include "fem/space/natural_boundary.h"

namespace smoothfem {

/// Finds the facets of natural conditions among the known nodes and dofs of a space. curved: its
/// points; null in straight-sided spaces.
template <int dim>
void find_natural_facets(const NaturalBoundary& natural, CurvedPoints<dim>* curved,
                         FiniteElementSpace<dim>& space);

/// Computes b_i += integral of (A grad u . n) phi_i over the facets of natural conditions, for this
/// rank's free dofs. x: coordinates of the local points. materials: of the
/// kinds of cells; empty if A is a function of the position.
template <int dim>
void add_natural_load(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
                      const ManufacturedSolution<dim>& solution,
                      const std::vector<std::uint32_t>& materials,
                      Eigen::VectorXd& right_hand_side);

}  // namespace smoothfem
