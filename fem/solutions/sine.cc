// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "fem/solutions/manufactured_solution.h"

namespace smoothfem {

namespace {

/// The product of sin(pi x_d).
template <int dim>
ManufacturedSolution<dim> sine_solution() {
  constexpr double pi = std::numbers::pi;
  const auto value = [](const Point<dim>& p) {
    double product = 1.0;
    for (int d = 0; d < dim; ++d) product *= std::sin(pi * p[d]);
    return product;
  };
  return {.name = "sine",
          .formula = dim == 2 ? "sin(pi x) sin(pi y)" : "sin(pi x) sin(pi y) sin(pi z)",
          .source = "the common first test",
          .value = value,
          .value_and_gradient = [=](const Point<dim>& p) -> ValueAndGradient<dim> {
            Point<dim> gradient;
            for (int k = 0; k < dim; ++k) {
              gradient[k] = pi * std::cos(pi * p[k]);
              for (int d = 0; d < dim; ++d)
                if (d != k) gradient[k] *= std::sin(pi * p[d]);
            }
            return {value(p), gradient};
          },
          .load = [=](const Point<dim>& p) { return dim * pi * pi * value(p); }};
}

const RegisteredSolution<2> planar(sine_solution<2>());
const RegisteredSolution<3> volume(sine_solution<3>());

}  // namespace

}  // namespace smoothfem
