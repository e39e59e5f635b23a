// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <numbers>

#include "smoothing/polygons/polygon.h"
#include "smoothing/tests/planar_meshes.h"

namespace smoothfem::test {

constexpr double pi = std::numbers::pi;
constexpr std::size_t max_nodes = 12;  ///< of the test polygons

/// Makes a polygon with nodes uniform in the square from -1 - i to 1 + i.
inline Polygon random_polygon(std::size_t n, Random& random) {
  Polygon polygon;
  for (std::size_t k = 0; k < n; ++k) {
    const double x = random(), y = random();
    polygon.emplace_back(x, y);
  }
  return polygon;
}

/// Makes a random counterclockwise triangle.
inline Polygon random_triangle(Random& random) {
  Polygon triangle = random_polygon(3, random);
  if (signed_area(triangle) < 0.0) std::swap(triangle[1], triangle[2]);
  return triangle;
}

inline Polygon unit_polygon(std::size_t n, std::size_t k) {
  Polygon polygon(n);
  polygon[k] = 1.0;
  return polygon;
}

/// Returns the matrix of a transformation, column by column, from its effect on single nodes.
inline Eigen::MatrixXcd matrix_of(std::size_t n,
                                  const std::function<Polygon(const Polygon&)>& step) {
  Eigen::MatrixXcd matrix(n, n);
  for (std::size_t k = 0; k < n; ++k) {
    const Polygon column = step(unit_polygon(n, k));
    for (std::size_t m = 0; m < n; ++m) matrix(m, k) = column[m];
  }
  return matrix;
}

}  // namespace smoothfem::test
