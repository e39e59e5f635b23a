// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/function.h>
#include <deal.II/numerics/vector_tools.h>

#include "fem/deal_ii/lagrange_space.h"
#include "fem/solutions/manufactured_solution.h"

namespace smoothfem {

template <int dim>
Point<dim> point_from(const dealii::Point<dim>& p) {
  Point<dim> point;
  for (int d = 0; d < dim; ++d) point[d] = p[d];
  return point;
}

/// A manufactured solution in the form of deal.II's functions.
template <int dim>
class SolutionFunction final : public dealii::Function<dim> {
 public:
  explicit SolutionFunction(const ManufacturedSolution<dim>& solution) : solution_(solution) {}

  double value(const dealii::Point<dim>& p, unsigned int /*component*/ = 0) const override {
    return solution_.value(point_from(p));
  }

  dealii::Tensor<1, dim> gradient(const dealii::Point<dim>& p,
                                  unsigned int /*component*/ = 0) const override {
    const auto gradient = solution_.value_and_gradient(point_from(p)).gradient;
    dealii::Tensor<1, dim> result;
    for (int d = 0; d < dim; ++d) result[d] = gradient[d];
    return result;
  }

 private:
  const ManufacturedSolution<dim>& solution_;
};

/// Returns the constraints of a scalar problem: u on the boundary, and the ties of the mesh.
template <int dim>
dealii::AffineConstraints<double> boundary_values(const LagrangeSpace<dim>& space,
                                                  const ManufacturedSolution<dim>& solution) {
  dealii::AffineConstraints<double> constraints(space.relevant_dofs);
  const auto points = space.support_points();
  space.for_each_boundary_dof([&](auto dof, unsigned int, auto) {
    constraints.add_line(dof);
    constraints.set_inhomogeneity(dof, solution.value(point_from(points.at(dof))));
  });
  space.add_ties(constraints);
  constraints.close();
  return constraints;
}

/// Returns the error of a scalar u_h in a norm, by the quadrature of the space. u_h: with the
/// relevant dofs. Collective.
template <int dim, class Vector>
double error_of(const Vector& u_h, const LagrangeSpace<dim>& space,
                const ManufacturedSolution<dim>& solution, dealii::VectorTools::NormType norm) {
  const auto& triangulation = space.dofs.get_triangulation();
  dealii::Vector<double> of_cells(triangulation.n_active_cells());
  dealii::VectorTools::integrate_difference(space.mappings, space.dofs, u_h,
                                            SolutionFunction<dim>(solution), of_cells, space.rules,
                                            norm);
  return dealii::VectorTools::compute_global_error(triangulation, of_cells, norm);
}

}  // namespace smoothfem
