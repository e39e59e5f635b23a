// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "smoothing/polygons/eigenpolygons.h"

namespace smoothfem {

/// Returns the eigenvalues eta_k = |1 - conj(w) + r^k conj(w)|^2 of the combined transformation on
/// n-gons, with w = lambda + i (1 - lambda) tan(theta) and r = exp(2 pi i / n). Source: thesis,
/// Lemma 2.11, where the conjugates are missing in the printed formula. They are real, not
/// negative, and eta_0 = 1. lambda in (0, 1), theta in (0, pi/2), n >= 3.
std::vector<double> eigenvalues(double lambda, double theta, std::size_t n);

/// Returns the lambda, as a function of theta, for which eigenvalues k != m with (k + m) mod n =
/// sum are equal, 0 < sum < n (Lemma 2.13). A result outside (0, 1) means that they are never equal
/// for this theta.
double intersection_line(std::size_t n, std::size_t sum, double theta);

/// Limit of n-gons under the repeated transformation, scaled about their centroid by 1 / growth in
/// every step (thesis, Definition 2.5 and Theorem 2.13).
struct PolygonLimit {
  enum class Shape {
    point,       ///< D_0: the centroid
    regular,     ///< convex and regular: D_1, S_0, D_k where k divides n; vertices may be multiple
    star,        ///< D_k: a regular star
    segment,     ///< D_{n/2}: two vertices
    combination  ///< S_k, k >= 1: the sum of two eigenpolygons, not an affine image of a regular
                 ///< polygon
  };
  /// Indices of the largest eigenvalue: {k} in the domain D_k, {k, k + 1} on the line S_k.
  std::vector<std::size_t> dominant;
  Shape shape = Shape::point;
  StarPolygon star{};  ///< star polygon of the first dominant index that is not 0; of 0 for a point
  double growth = 1.0;  ///< largest eigenvalue: asymptotic growth of lengths in a step
  /// Next eigenvalue / largest one, in [0, 1): the asymptotic factor of the error in a step.
  double convergence = 0.0;
};

/// Returns "D_k" or "S_k".
std::string domain_name(const PolygonLimit& limit);
std::string shape_name(PolygonLimit::Shape shape);

/// Returns the limit of n-gons whose dominant eigenpolygon does not vanish. The phase phi of w (1 -
/// conj w) decides: eta_k = a + b cos(2 pi k / n - phi) with b > 0. So the largest eigenvalue is
/// that of the integer nearest to n phi / (2 pi); on S_k this number is k + 1/2 (up to 1e-10).
/// Throws InputError unless lambda is in (0, 1), theta in (0, pi/2) and n >= 3.
PolygonLimit classify(double lambda, double theta, std::size_t n);

/// Returns the limit for the one-step transformation by isosceles triangles (thesis, Section 2.2).
/// Its eigenvalues are complex; growth and convergence refer to their moduli. The limit turns with
/// a period of 2n steps (Theorems 2.10 to 2.12).
PolygonLimit classify_isosceles(double theta, std::size_t n);

/// Returns the limit of the scaled iterates of a polygon (Theorem 2.13): its centroid and dominant
/// eigenpolygons.
Polygon limit_polygon(const Polygon& polygon, const PolygonLimit& limit);

}  // namespace smoothfem
