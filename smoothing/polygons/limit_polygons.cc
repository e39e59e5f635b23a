// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/polygons/limit_polygons.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

constexpr double pi = std::numbers::pi;

Complex weight(double lambda, double theta) {
  return {lambda, (1.0 - lambda) * std::tan(theta)};
}

void require_range(double lambda, double theta, std::size_t n) {
  if (!(lambda > 0.0 && lambda < 1.0))
    throw InputError("lambda of a polygon transformation is " + std::to_string(lambda) +
                     "; choose a number between 0 and 1");
  if (!(theta > 0.0 && theta < 0.5 * pi))
    throw InputError("theta of a polygon transformation is " + std::to_string(theta) +
                     "; choose an angle between 0 and pi/2");
  if (n < 3)
    throw InputError("a polygon of " + std::to_string(n) +
                     " nodes cannot be transformed; it needs at least three");
}

/// Returns n phi / (2 pi), in (0, n/2). The nearer k is to it, the larger is eigenvalue k.
double dominant_index(double lambda, double theta, std::size_t n) {
  const double sine = std::sin(theta);
  return static_cast<double>(n) * std::atan2(sine * std::cos(theta), lambda - sine * sine) /
         (2.0 * pi);
}

std::vector<std::size_t> dominant_indices(double index) {
  constexpr double tolerance = 1e-10;
  const double below = std::floor(index);
  const auto k = static_cast<std::size_t>(below);
  if (std::abs(index - below - 0.5) <= tolerance) return {k, k + 1};
  return {static_cast<std::size_t>(std::floor(index + 0.5))};
}

PolygonLimit::Shape shape_of(const PolygonLimit& limit) {
  using enum PolygonLimit::Shape;
  if (limit.dominant.front() > 0 && limit.dominant.size() > 1) return combination;
  if (limit.star.vertices == 1) return point;
  if (limit.star.vertices == 2) return segment;
  return limit.star.density == 1 ? regular : star;
}

}  // namespace

std::vector<double> eigenvalues(double lambda, double theta, std::size_t n) {
  const Complex w = std::conj(weight(lambda, theta));
  std::vector<double> values;
  for (std::size_t k = 0; k < n; ++k)
    values.push_back(std::norm(1.0 - w + root_of_unity(n, k) * w));
  return values;
}

double intersection_line(std::size_t n, std::size_t sum, double theta) {
  const double angle = pi * static_cast<double>(sum) / static_cast<double>(n);
  return std::sin(theta) * (std::sin(theta) + std::cos(theta) * std::cos(angle) / std::sin(angle));
}

std::string domain_name(const PolygonLimit& limit) {
  return (limit.dominant.size() == 1 ? "D_" : "S_") + std::to_string(limit.dominant.front());
}

std::string shape_name(PolygonLimit::Shape shape) {
  using enum PolygonLimit::Shape;
  switch (shape) {
    case point:
      return "point";
    case regular:
      return "regular";
    case star:
      return "star";
    case segment:
      return "segment";
    case combination:
      break;
  }
  return "combination";
}

PolygonLimit classify(double lambda, double theta, std::size_t n) {
  require_range(lambda, theta, n);
  PolygonLimit limit;
  limit.dominant = dominant_indices(dominant_index(lambda, theta, n));
  const bool bounded = limit.dominant.size() == 2 && limit.dominant.front() == 0;  // S_0
  limit.star = star_polygon(n, bounded ? 1 : limit.dominant.front());
  limit.shape = shape_of(limit);
  auto values = eigenvalues(lambda, theta, n);
  limit.growth = values[limit.dominant.front()];
  for (const std::size_t k : limit.dominant) values[k] = 0.0;
  limit.convergence = *std::max_element(values.begin(), values.end()) / limit.growth;
  return limit;
}

PolygonLimit classify_isosceles(double theta, std::size_t n) {
  PolygonLimit limit = classify(0.5, theta, n);
  limit.growth = std::sqrt(limit.growth);
  limit.convergence = std::sqrt(limit.convergence);
  return limit;
}

Polygon limit_polygon(const Polygon& polygon, const PolygonLimit& limit) {
  const auto all = eigenpolygon_coefficients(polygon);
  std::vector<Complex> kept(all.size());
  kept[0] = all[0];
  for (const std::size_t k : limit.dominant) kept[k] = all[k];
  return sum_of_eigenpolygons(kept);
}

}  // namespace smoothfem
