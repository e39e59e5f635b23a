// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/polygons/polygon.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "smoothing/transformations/polygon_transformation.h"

namespace smoothfem {

Complex centroid(const Polygon& polygon) {
  return std::accumulate(polygon.begin(), polygon.end(), Complex()) /
         static_cast<double>(polygon.size());
}

double signed_area(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k)
    twice += (std::conj(polygon[k]) * polygon[(k + 1) % polygon.size()]).imag();
  return 0.5 * twice;
}

double radius(const Polygon& polygon) {
  const Complex middle = centroid(polygon);
  double sum = 0.0;
  for (const Complex& z : polygon) sum += std::norm(z - middle);
  return std::sqrt(sum / static_cast<double>(polygon.size()));
}

double distance(const Polygon& a, const Polygon& b) {
  double longest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) longest = std::max(longest, std::abs(a[k] - b[k]));
  return longest;
}

Polygon scaled_about(Complex centre, Polygon polygon, double factor) {
  for (Complex& z : polygon) z = centre + factor * (z - centre);
  return polygon;
}

Polygon scaled_about_centroid(Polygon polygon, double factor) {
  const Complex middle = centroid(polygon);
  return scaled_about(middle, std::move(polygon), factor);
}

Polygon transformed(const Polygon& polygon, double lambda, double theta) {
  std::vector<Vector2<double>> before, after(polygon.size());
  for (const Complex& z : polygon) before.push_back({z.real(), z.imag()});
  PolygonTransformation(lambda, theta)
      .apply(std::span<const Vector2<double>>(before), std::span<Vector2<double>>(after));
  Polygon result;
  for (const auto& p : after) result.emplace_back(p.x, p.y);
  return result;
}

}  // namespace smoothfem
