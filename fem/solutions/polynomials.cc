// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "fem/solutions/manufactured_solution.h"

namespace smoothfem {

namespace {

/// The polynomials below; in space with an additional part in z.
template <int dim>
double z_of(const Point<dim>& p) {
  return dim == 2 ? 0.0 : p[dim - 1];
}

/// In the plane `xy`; in space with the derivative by z.
template <int dim>
Point<dim> with_z(const Point<2>& xy, double z) {
  Point<dim> result = Point<dim>::Constant(z);
  result.template head<2>() = xy;
  return result;
}

template <int dim>
ManufacturedSolution<dim> linear_solution() {
  const auto value = [](const Point<dim>& p) {
    return 1.0 + 2.0 * p.x() - 3.0 * p.y() + 0.5 * z_of<dim>(p);
  };
  return {.name = "linear",
          .formula = dim == 2 ? "1 + 2 x - 3 y" : "1 + 2 x - 3 y + z / 2",
          .source = "lies in every space: errors are round-off",
          .value = value,
          .value_and_gradient = [=](const Point<dim>& p) -> ValueAndGradient<dim> {
            return {value(p), with_z<dim>({2.0, -3.0}, 0.5)};
          },
          .load = [](const Point<dim>&) { return 0.0; }};
}

template <int dim>
ManufacturedSolution<dim> quadratic_solution() {
  const auto value = [](const Point<dim>& p) {
    const double x = p.x(), y = p.y(), z = z_of<dim>(p);
    return x * x + x * y - 2.0 * y * y + y + z * (3.0 * z - x);
  };
  return {.name = "quadratic",
          .formula = dim == 2 ? "x^2 + x y - 2 y^2 + y" : "x^2 + x y - 2 y^2 + y + 3 z^2 - x z",
          .source = "lies in the spaces of degree 2: errors are round-off",
          .value = value,
          .value_and_gradient = [=](const Point<dim>& p) -> ValueAndGradient<dim> {
            const double x = p.x(), y = p.y(), z = z_of<dim>(p);
            return {value(p), with_z<dim>({2.0 * x + y - z, x - 4.0 * y + 1.0}, 6.0 * z - x)};
          },
          .load = [](const Point<dim>&) { return dim == 2 ? 2.0 : -4.0; }};
}

const RegisteredSolution<2> planar_linear(linear_solution<2>());
const RegisteredSolution<3> volume_linear(linear_solution<3>());
const RegisteredSolution<2> planar_quadratic(quadratic_solution<2>());
const RegisteredSolution<3> volume_quadratic(quadratic_solution<3>());

}  // namespace

}  // namespace smoothfem
