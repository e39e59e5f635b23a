// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "fem/solutions/manufactured_solution.h"

namespace smoothfem {

namespace {

/// atan(steepness (r - radius)), r the distance from a point outside of the unit square.
template <int dim>
ManufacturedSolution<dim> front_solution() {
  constexpr double steepness = 60.0, radius = 0.7;
  const Point<dim> centre = Point<dim>::Constant(-0.05);
  const auto argument = [=](const Point<dim>& p) {
    return steepness * ((p - centre).norm() - radius);
  };
  return {.name = "front",
          .formula = dim == 2 ? "atan(60 (|(x, y) + (.05, .05)| - .7))"
                              : "atan(60 (|(x, y, z) + (.05, .05, .05)| - .7))",
          .source = "circular front (Mitchell 2013, Section 2.7)",
          .value = [=](const Point<dim>& p) { return std::atan(argument(p)); },
          .value_and_gradient = [=](const Point<dim>& p) -> ValueAndGradient<dim> {
            const double s = argument(p);
            return {std::atan(s), steepness / (1.0 + s * s) * (p - centre).normalized()};
          },
          .load =
              [=](const Point<dim>& p) {
                // u'' + (dim - 1) u' / r
                const double s = argument(p), first = steepness / (1.0 + s * s);
                return 2.0 * s * first * first - (dim - 1) * first / (p - centre).norm();
              }};
}

/// exp(-sharpness |p - centre|^2)
template <int dim>
ManufacturedSolution<dim> peak_solution() {
  constexpr double sharpness = 1000.0;
  const Point<dim> centre = Point<dim>::Constant(0.5);
  const auto value = [=](const Point<dim>& p) {
    return std::exp(-sharpness * (p - centre).squaredNorm());
  };
  return {.name = "peak",
          .formula = dim == 2 ? "exp(-1000 |(x, y) - (.5, .5)|^2)"
                              : "exp(-1000 |(x, y, z) - (.5, .5, .5)|^2)",
          .source = "peak (Mitchell 2013, Section 2.3)",
          .value = value,
          .value_and_gradient = [=](const Point<dim>& p) -> ValueAndGradient<dim> {
            return {value(p), -2.0 * sharpness * value(p) * (p - centre)};
          },
          .load =
              [=](const Point<dim>& p) {
                return 2.0 * sharpness * value(p) *
                       (dim - 2.0 * sharpness * (p - centre).squaredNorm());
              }};
}

/// r^(2/3) sin(2 theta / 3), theta from the positive x axis: zero on both sides of the re-entrant
/// corner of three quadrants, harmonic, and with an infinite gradient in the corner.
ManufacturedSolution<2> corner_solution() {
  constexpr double exponent = 2.0 / 3.0;
  const auto angle = [](const Point<2>& p) {
    const double theta = std::atan2(p.y(), p.x());
    return theta < 0.0 ? theta + 2.0 * std::numbers::pi : theta;
  };
  const auto value = [=](const Point<2>& p) {
    return std::pow(p.norm(), exponent) * std::sin(exponent * angle(p));
  };
  return {.name = "corner",
          .formula = "r^(2/3) sin(2/3 theta)",
          .source = "L-shape (Mitchell 2013, Section 2.2)",
          .value = value,
          .value_and_gradient = [=](const Point<2>& p) -> ValueAndGradient<2> {
            const double slope = exponent * std::pow(p.norm(), exponent - 1.0);
            const double turned = (exponent - 1.0) * angle(p);
            return {value(p), slope * Point<2>(std::sin(turned), std::cos(turned))};
          },
          .load = [](const Point<2>&) { return 0.0; }};
}

/// r^(1/2): its gradient is infinite in the re-entrant corner of seven octants. Unlike solutions
/// with a smooth load, it is bounded along the three edges that meet there.
ManufacturedSolution<3> fichera_solution() {
  constexpr double exponent = 0.5;
  const auto value = [=](const Point<3>& p) { return std::pow(p.norm(), exponent); };
  return {.name = "corner",
          .formula = "r^(1/2)",
          .source = "Fichera corner (benchmark of Hermes3D)",
          .value = value,
          .value_and_gradient = [=](const Point<3>& p) -> ValueAndGradient<3> {
            return {value(p), exponent * std::pow(p.norm(), exponent - 2.0) * p};
          },
          .load =
              [=](const Point<3>& p) {
                return -exponent * (exponent + 1.0) * std::pow(p.norm(), exponent - 2.0);
              }};
}

const RegisteredSolution<2> planar_front(front_solution<2>());
const RegisteredSolution<3> volume_front(front_solution<3>());
const RegisteredSolution<2> planar_peak(peak_solution<2>());
const RegisteredSolution<3> volume_peak(peak_solution<3>());
const RegisteredSolution<2> planar_corner(corner_solution());
const RegisteredSolution<3> volume_corner(fichera_solution());

}  // namespace

}  // namespace smoothfem
