// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/polygons/limit_polygons.h"

namespace smoothfem {

/// The apex of the isosceles triangle with base a b and base angle theta, to the right of the way
/// from a to b: outside of counterclockwise polygons. theta in (-pi/2, pi/2); 0: the midpoint,
/// negative: to the left.
Complex isosceles_apex(Complex a, Complex b, double theta);

/// One step of Section 2.2 of the thesis: node k becomes the apex over the side from k to k + 1.
/// Keeps the centroid; turns the polygon. theta in (-pi/2, pi/2).
Polygon isosceles_step(const Polygon& polygon, double theta);

/// Its eigenvalues sec(theta) cos(theta - pi k / n) exp(i pi k / n) (Lemma 2.7).
std::vector<Complex> isosceles_eigenvalues(double theta, std::size_t n);

/// What the `step`-th scaled iterate of a polygon comes ever closer to (Theorem 2.10), theta in
/// (0, pi/2): its centroid and dominant eigenpolygons, eigenpolygon k turned by pi k step / n.
Polygon isosceles_limit(const Polygon& polygon, double theta, std::size_t step);

/// Napoleon's theorem: the centroids of equilateral triangles on the sides of a triangle, outside
/// if it is counterclockwise. An equilateral triangle, whatever the triangle was.
Polygon napoleon_triangle(const Polygon& triangle);

/// The theorem of Petr, Douglas and Neumann: n - 2 steps with the angles pi (2j - n) / (2n), j = 1,
/// ..., n - 1 without k (thesis, Lemma 2.12), make of every n-gon the regular one of kind k: a
/// turned and scaled eigenpolygon k. 0 < k < n.
Polygon petr_douglas_neumann_polygon(const Polygon& polygon, std::size_t k);

}  // namespace smoothfem
