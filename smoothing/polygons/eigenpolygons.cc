// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/polygons/eigenpolygons.h"

#include <cmath>
#include <numbers>
#include <numeric>

namespace smoothfem {

namespace {

std::vector<Complex> roots_of_unity(std::size_t n) {
  std::vector<Complex> roots;
  for (std::size_t k = 0; k < n; ++k) roots.push_back(root_of_unity(n, k));
  return roots;
}

}  // namespace

Complex root_of_unity(std::size_t n, std::size_t k) {
  return std::polar(1.0, 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
}

std::vector<Complex> eigenpolygon_coefficients(const Polygon& polygon) {
  const std::size_t n = polygon.size();
  const auto roots = roots_of_unity(n);
  std::vector<Complex> coefficients(n);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t m = 0; m < n; ++m) coefficients[k] += polygon[m] * std::conj(roots[m * k % n]);
    coefficients[k] /= static_cast<double>(n);
  }
  return coefficients;
}

Polygon eigenpolygon(std::size_t n, std::size_t k, Complex first_node) {
  Polygon polygon;
  for (std::size_t m = 0; m < n; ++m) polygon.push_back(first_node * root_of_unity(n, m * k % n));
  return polygon;
}

Polygon sum_of_eigenpolygons(const std::vector<Complex>& coefficients) {
  const std::size_t n = coefficients.size();
  const auto roots = roots_of_unity(n);
  Polygon polygon(n);
  for (std::size_t m = 0; m < n; ++m)
    for (std::size_t k = 0; k < n; ++k) polygon[m] += coefficients[k] * roots[m * k % n];
  return polygon;
}

StarPolygon star_polygon(std::size_t n, std::size_t k) {
  const std::size_t multiplicity = std::gcd(n, k), vertices = n / multiplicity;
  const std::size_t step = k / multiplicity;
  const bool clockwise = 2 * step > vertices;
  return {.vertices = vertices,
          .multiplicity = multiplicity,
          .density = clockwise ? vertices - step : step,
          .direction = vertices <= 2 ? 0
                       : clockwise   ? -1
                                     : 1};
}

}  // namespace smoothfem
