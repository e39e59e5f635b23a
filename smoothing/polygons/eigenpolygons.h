// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/polygons/polygon.h"

namespace smoothfem {

/// Returns exp(2 pi i k / n), n >= 1.
Complex root_of_unity(std::size_t n, std::size_t k);

/// Decomposes a polygon into its eigenpolygons v_0, ..., v_{n-1} (thesis, Definition 2.2). Entry k
/// is the first node of v_k; node m of v_k is that times root_of_unity(n, m k). v_0 is n times the
/// centroid. Computed as n Fourier sums.
std::vector<Complex> eigenpolygon_coefficients(const Polygon& polygon);

/// Returns v_k of n nodes with the given first node, k < n.
Polygon eigenpolygon(std::size_t n, std::size_t k, Complex first_node);

/// Returns the sum of all eigenpolygons: the polygon that has these coefficients.
Polygon sum_of_eigenpolygons(const std::vector<Complex>& coefficients);

/// The regular polygon of eigenpolygon k of n nodes (thesis, Theorem 2.11).
struct StarPolygon {
  std::size_t vertices = 1;      ///< n / gcd(n, k): 1 a point, 2 a segment
  std::size_t multiplicity = 1;  ///< nodes at each vertex: gcd(n, k)
  /// Number of vertices from one node to the next: {vertices/density} in Schlaefli's notation; 1:
  /// convex.
  std::size_t density = 0;
  int direction = 0;  ///< 1 counterclockwise, -1 clockwise, 0 a point or a segment
};
StarPolygon star_polygon(std::size_t n, std::size_t k);

}  // namespace smoothfem
