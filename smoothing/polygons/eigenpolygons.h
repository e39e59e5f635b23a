// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/polygons/polygon.h"

namespace smoothfem {

/// exp(2 pi i k / n), n >= 1.
Complex root_of_unity(std::size_t n, std::size_t k);

/// The decomposition of a polygon into its eigenpolygons v_0, ..., v_{n-1} (thesis,
/// Definition 2.2): entry k is the first node of v_k, and node m of v_k is that times
/// root_of_unity(n, m k). v_0 is n times the centroid. n Fourier sums.
std::vector<Complex> eigenpolygon_coefficients(const Polygon& polygon);

/// v_k of n nodes with its first node, k < n.
Polygon eigenpolygon(std::size_t n, std::size_t k, Complex first_node);

/// The sum of all eigenpolygons: the polygon that has these coefficients.
Polygon sum_of_eigenpolygons(const std::vector<Complex>& coefficients);

/// The regular polygon that eigenpolygon k of n nodes is (thesis, Theorem 2.11).
struct StarPolygon {
  std::size_t vertices = 1;      ///< n / gcd(n, k): 1 a point, 2 a segment
  std::size_t multiplicity = 1;  ///< nodes at each vertex: gcd(n, k)
  /// From one node to the next this many vertices further: {vertices/density} in Schlaefli's
  /// notation; 1: convex.
  std::size_t density = 0;
  int direction = 0;  ///< 1 counterclockwise, -1 clockwise, 0 a point or a segment
};
StarPolygon star_polygon(std::size_t n, std::size_t k);

}  // namespace smoothfem
