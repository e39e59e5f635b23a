// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/polygons/triangle_transformations.h"

#include <array>
#include <cmath>
#include <numbers>

#include "smoothing/polygons/isosceles_transformation.h"

namespace smoothfem {

namespace {

Polygon apices_over_opposite_sides(const Polygon& triangle, const std::array<double, 3>& theta) {
  Polygon result;
  for (std::size_t k = 0; k < 3; ++k)
    result.push_back(isosceles_apex(triangle[(k + 1) % 3], triangle[(k + 2) % 3], theta[k]));
  return result;
}

/// Returns the angle at a between the directions to b and c.
double angle_at(Complex a, Complex b, Complex c) {
  return std::abs(std::arg((c - a) * std::conj(b - a)));
}

/// Returns either convergence factor, for s = 3 tan(theta)^2 or s = tan(theta)^2.
double convergence_factor(double s) {
  return (1.0 - s) * (1.0 - s) / (1.0 + s * s);
}

double squared_tangent(double theta) {
  return std::tan(theta) * std::tan(theta);
}

}  // namespace

TriangleSides sides_of(const Polygon& triangle) {
  return {std::abs(triangle[2] - triangle[1]), std::abs(triangle[0] - triangle[2]),
          std::abs(triangle[1] - triangle[0])};
}

TriangleAngles angles_of(const Polygon& triangle) {
  return {angle_at(triangle[0], triangle[1], triangle[2]),
          angle_at(triangle[1], triangle[2], triangle[0]),
          angle_at(triangle[2], triangle[0], triangle[1])};
}

Polygon equilateral_step(const Polygon& triangle, double theta) {
  return apices_over_opposite_sides(triangle, {theta, theta, theta});
}

Polygon right_isosceles_step(const Polygon& triangle, double theta) {
  return apices_over_opposite_sides(triangle, {0.0, theta, theta});
}

double equilateral_convergence_factor(double theta) {
  return convergence_factor(3.0 * squared_tangent(theta));
}

double right_isosceles_convergence_factor(double theta) {
  return convergence_factor(squared_tangent(theta));
}

double equilateral_growth(double theta) {
  return 0.5 * (1.0 + std::numbers::sqrt3 * std::tan(theta));
}

double right_isosceles_growth(double theta) {
  return 0.5 * (1.0 + std::tan(theta));
}

}  // namespace smoothfem
