// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/numerics/error_estimator.h>

#include <cmath>

#include "fem/deal_ii/lagrange_space.h"
#include "fem/ranks/ranks.h"
#include "fem/solvers/mesh_solver.h"

namespace smoothfem {

/// True if the mesh has one type of cells, and deal.II can integrate over their facets.
template <int dim>
bool has_kelly(const LagrangeSpace<dim>& space) {
  const auto& types = space.dofs.get_triangulation().get_reference_cells();
  return types.size() == 1 && !has_facets_of_two_shapes(types[0]);
}

/// Returns deal.II's Kelly indicator of each cell, of the jumps of grad u_h across facets: its
/// square is a cell's part of the estimate's square. Throws SolverFailure unless has_kelly.
template <int dim, class Vector>
dealii::Vector<float> kelly_indicators(const LagrangeSpace<dim>& space, const Vector& u_h) {
  if (!has_kelly(space))
    throw SolverFailure(
        "Kelly's indicators need a mesh of one type of cells, and not of pyramids or prisms");
  dealii::Vector<float> of_cells(space.dofs.get_triangulation().n_active_cells());
  dealii::KellyErrorEstimator<dim>::estimate(space.mappings[0], space.dofs, space.facet_rules, {},
                                             u_h, of_cells);
  return of_cells;
}

/// Returns the estimate, of the cells of all ranks.
template <int dim, class Vector>
double kelly_estimate(const LagrangeSpace<dim>& space, const Vector& u_h, const Ranks& ranks) {
  double sum = 0.0;
  for (const double indicator : kelly_indicators(space, u_h)) sum += indicator * indicator;
  return std::sqrt(ranks.sum(sum));
}

/// Returns Kelly's indicators divided by the square roots of the cells' sizes: means over the
/// cells, which methods that move nodes compare.
template <int dim, class Vector>
dealii::Vector<float> kelly_means(const LagrangeSpace<dim>& space, const Vector& u_h) {
  auto of_cells = kelly_indicators(space, u_h);
  for (const auto& cell : space.dofs.active_cell_iterators())
    of_cells[cell->active_cell_index()] /= static_cast<float>(std::sqrt(cell->measure()));
  return of_cells;
}

}  // namespace smoothfem
