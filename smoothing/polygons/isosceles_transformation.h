// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/polygons/limit_polygons.h"

namespace smoothfem {

/// Returns the apex of the isosceles triangle with base a b and base angle theta, on the right of
/// the way from a to b: outside of counterclockwise polygons. theta in (-pi/2, pi/2); 0: the
/// midpoint, negative: on the left.
Complex isosceles_apex(Complex a, Complex b, double theta);

/// Makes one step of Section 2.2 of the thesis: node k becomes the apex over the side from k to k +
/// 1. Keeps the centroid; turns the polygon. theta in (-pi/2, pi/2).
Polygon isosceles_step(const Polygon& polygon, double theta);

/// Returns its eigenvalues sec(theta) cos(theta - pi k / n) exp(i pi k / n) (Lemma 2.7).
std::vector<Complex> isosceles_eigenvalues(double theta, std::size_t n);

/// Returns the polygon that the `step`-th scaled iterate of a polygon approaches (Theorem 2.10),
/// theta in (0, pi/2). It has the polygon's centroid and dominant eigenpolygons; eigenpolygon k is
/// turned by pi k step / n.
Polygon isosceles_limit(const Polygon& polygon, double theta, std::size_t step);

/// Returns the centroids of equilateral triangles on the sides of a triangle, outside if it is
/// counterclockwise. They form an equilateral triangle for every triangle (Napoleon's theorem).
Polygon napoleon_triangle(const Polygon& triangle);

/// Returns the regular n-gon of kind k, a turned and scaled eigenpolygon k, 0 < k < n. Theorem of
/// Petr, Douglas and Neumann: n - 2 steps turn every n-gon into it. Their angles are pi (2j - n) /
/// (2n), j = 1, ..., n - 1 without k (thesis, Lemma 2.12).
Polygon petr_douglas_neumann_polygon(const Polygon& polygon, std::size_t k);

}  // namespace smoothfem
