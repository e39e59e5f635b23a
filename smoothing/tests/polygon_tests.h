#pragma once

#include <numbers>

#include "smoothing/polygons/polygon.h"
#include "smoothing/tests/planar_meshes.h"

namespace smoothfem::test {

constexpr double pi = std::numbers::pi;

/// Nodes uniform in the square from -1 - i to 1 + i.
inline Polygon random_polygon(std::size_t n, Random& random) {
  Polygon polygon;
  for (std::size_t k = 0; k < n; ++k) {
    const double x = random(), y = random();
    polygon.emplace_back(x, y);
  }
  return polygon;
}

/// Any counterclockwise triangle.
inline Polygon random_triangle(Random& random) {
  Polygon triangle = random_polygon(3, random);
  if (signed_area(triangle) < 0.0) std::swap(triangle[1], triangle[2]);
  return triangle;
}

}  // namespace smoothfem::test
