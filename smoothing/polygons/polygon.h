// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace smoothfem {

using Complex = std::complex<double>;

/// A planar polygon: n >= 3 nodes as complex numbers. Sides join neighbours, and the last node with
/// the first. It may intersect itself, and nodes may coincide.
using Polygon = std::vector<Complex>;

/// Returns the mean of the nodes.
Complex centroid(const Polygon& polygon);

/// Returns the signed area: positive for counterclockwise triangles and convex polygons.
double signed_area(const Polygon& polygon);

/// Returns the root mean square distance of the nodes from their centroid.
double radius(const Polygon& polygon);

/// Returns the largest distance between nodes of the same number. Both polygons have the same
/// number of nodes.
double distance(const Polygon& a, const Polygon& b);

/// Returns the polygon, enlarged by a factor about a point.
Polygon scaled_about(Complex centre, Polygon polygon, double factor);

/// Returns the polygon, enlarged by a factor about its centroid.
Polygon scaled_about_centroid(Polygon polygon, double factor);

/// Makes one step of the combined transformation of Section 2.3 (PolygonTransformation). lambda in
/// (0, 1), theta in (0, pi/2).
Polygon transformed(const Polygon& polygon, double lambda, double theta);

}  // namespace smoothfem
