// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/function.h>

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

}  // namespace smoothfem
