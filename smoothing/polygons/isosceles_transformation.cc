// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/polygons/isosceles_transformation.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace smoothfem {

namespace {

constexpr double pi = std::numbers::pi;

double half_angle(std::size_t n, std::size_t k) {
  return pi * static_cast<double>(k) / static_cast<double>(n);
}

}  // namespace

Complex isosceles_apex(Complex a, Complex b, double theta) {
  const Complex w(0.5, 0.5 * std::tan(theta));
  return w * a + std::conj(w) * b;
}

Polygon isosceles_step(const Polygon& polygon, double theta) {
  Polygon result;
  for (std::size_t k = 0; k < polygon.size(); ++k)
    result.push_back(isosceles_apex(polygon[k], polygon[(k + 1) % polygon.size()], theta));
  return result;
}

std::vector<Complex> isosceles_eigenvalues(double theta, std::size_t n) {
  std::vector<Complex> values;
  for (std::size_t k = 0; k < n; ++k)
    values.push_back(std::cos(theta - half_angle(n, k)) / std::cos(theta) *
                     std::polar(1.0, half_angle(n, k)));
  return values;
}

Polygon isosceles_limit(const Polygon& polygon, double theta, std::size_t step) {
  const std::size_t n = polygon.size();
  const auto all = eigenpolygon_coefficients(polygon);
  std::vector<Complex> kept(n);
  for (const std::size_t k : classify_isosceles(theta, n).dominant)
    kept[k] = all[k] * root_of_unity(2 * n, k * step % (2 * n));
  kept[0] = all[0];
  return sum_of_eigenpolygons(kept);
}

Polygon napoleon_triangle(const Polygon& triangle) {
  assert(triangle.size() == 3);
  return isosceles_step(triangle, pi / 6.0);
}

Polygon petr_douglas_neumann_polygon(const Polygon& polygon, std::size_t k) {
  const std::size_t n = polygon.size();
  assert(k > 0 && k < n);
  Polygon result = polygon;
  for (std::size_t j = 1; j < n; ++j)
    if (j != k) result = isosceles_step(result, half_angle(n, j) - 0.5 * pi);
  return result;
}

}  // namespace smoothfem
