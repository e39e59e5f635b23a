// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/manufactured_solution.h"

#include <cmath>
#include <numbers>

#include "smoothing/base/find_named.h"

namespace smoothfem {

namespace {

/// amplitude sin((x + 1)(y - 1) / 2) + offset: with phi = (x + 1)(y - 1) / 2, |grad phi|^2 =
/// ((x + 1)^2 + (y - 1)^2) / 4 and laplace(phi) = 0.
ManufacturedSolution<2> gear_solution() {
  constexpr double amplitude = 40.0, offset = 60.0;
  const auto phase = [](const Point<2>& p) { return 0.5 * (p.x() + 1.0) * (p.y() - 1.0); };
  const auto phase_gradient = [](const Point<2>& p) {
    return Point<2>(0.5 * (p.y() - 1.0), 0.5 * (p.x() + 1.0));
  };
  return {.name = "gear",
          .formula = "40 sin((x + 1)(y - 1) / 2) + 60",
          .source = "Section 6.2",
          .value = [=](const Point<2>& p) { return amplitude * std::sin(phase(p)) + offset; },
          .value_and_gradient = [=](const Point<2>& p) -> ValueAndGradient<2> {
            return {amplitude * std::sin(phase(p)) + offset,
                    amplitude * std::cos(phase(p)) * phase_gradient(p)};
          },
          .load =
              [=](const Point<2>& p) {
                return amplitude * std::sin(phase(p)) * phase_gradient(p).squaredNorm();
              }};
}

/// amplitude sin(a) cos(b) + offset with a = 2x + y, b = y - 3z: |grad a|^2 = 5, |grad b|^2 = 10,
/// grad a . grad b = 1.
ManufacturedSolution<3> volume_solution() {
  constexpr double amplitude = 35.0, offset = 60.0;
  const auto a = [](const Point<3>& p) { return 2.0 * p.x() + p.y(); };
  const auto b = [](const Point<3>& p) { return p.y() - 3.0 * p.z(); };
  return {
      .name = "volume",
      .formula = "35 sin(2x + y) cos(y - 3z) + 60",
      .source = "Section 6.3",
      .value =
          [=](const Point<3>& p) { return amplitude * std::sin(a(p)) * std::cos(b(p)) + offset; },
      .value_and_gradient = [=](const Point<3>& p) -> ValueAndGradient<3> {
        const double sin_a = std::sin(a(p)), cos_a = std::cos(a(p));
        const double sin_b = std::sin(b(p)), cos_b = std::cos(b(p));
        return {amplitude * sin_a * cos_b + offset,
                amplitude * Point<3>(2.0 * cos_a * cos_b, cos_a * cos_b - sin_a * sin_b,
                                     3.0 * sin_a * sin_b)};
      },
      .load =
          [=](const Point<3>& p) {
            return amplitude *
                   (15.0 * std::sin(a(p)) * std::cos(b(p)) + 2.0 * std::cos(a(p)) * std::sin(b(p)));
          }};
}

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

/// The polynomials below, in space with a part in z.
template <int dim>
double z_of(const Point<dim>& p) {
  return dim == 2 ? 0.0 : p[dim - 1];
}

/// In the plane `xy`; in space with the derivative in z.
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

template <int dim>
ManufacturedSolution<dim> thesis_solution() {
  if constexpr (dim == 2)
    return gear_solution();
  else
    return volume_solution();
}

}  // namespace

template <int dim>
const std::vector<ManufacturedSolution<dim>>& manufactured_solutions() {
  static const std::vector<ManufacturedSolution<dim>> all{
      thesis_solution<dim>(), linear_solution<dim>(), quadratic_solution<dim>(),
      sine_solution<dim>()};
  return all;
}

template <int dim>
const ManufacturedSolution<dim>& manufactured_solution(const std::string& name) {
  return find_named(dim == 2 ? "planar solution" : "volume solution", name,
                    manufactured_solutions<dim>(),
                    [](const ManufacturedSolution<dim>& one) { return one.name; });
}

template const std::vector<ManufacturedSolution<2>>& manufactured_solutions();
template const std::vector<ManufacturedSolution<3>>& manufactured_solutions();
template const ManufacturedSolution<2>& manufactured_solution(const std::string&);
template const ManufacturedSolution<3>& manufactured_solution(const std::string&);

}  // namespace smoothfem
