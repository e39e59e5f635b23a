// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/polygons/polygon.h"

/// The triangle transformations of Section 2.1 of the thesis. Nodes A, B, C have numbers 0, 1, 2.
/// Isosceles triangles stand on the right of the sides: outside of counterclockwise triangles.
/// theta in (0, pi/2).
namespace smoothfem {

/// Lengths of the sides opposite A, B, C.
struct TriangleSides {
  double x, y, z;
};
TriangleSides sides_of(const Polygon& triangle);

/// Angles at A, B, C, in [0, pi]; no side may have length zero.
struct TriangleAngles {
  double alpha, beta, gamma;
};
TriangleAngles angles_of(const Polygon& triangle);

/// Moves every node to the apex over the opposite side (Section 2.1.2). Triangles become
/// equilateral.
Polygon equilateral_step(const Polygon& triangle, double theta);

/// Moves B and C to the apices over their opposite sides, and A to the midpoint of its own (Section
/// 2.1.3). Triangles become right-angled and isosceles, with the right angle at A.
Polygon right_isosceles_step(const Polygon& triangle, double theta);

/// Returns the factor by which 1 - y/x shrinks at least in two steps where x >= y (Proposition
/// 2.1): (1 - 3 t^2)^2 / (1 + 9 t^4), t = tan(theta). Below 1; exactly 0 for theta = pi/6.
double equilateral_convergence_factor(double theta);

/// Returns the factor (1 - t^2)^2 / (1 + t^4) for 1 - z/y where y >= z, and for |1 - (y^2 + z^2) /
/// x^2| (Propositions 2.3 and 2.4). Exactly 0 for theta = pi/4.
double right_isosceles_convergence_factor(double theta);

/// Return the asymptotic growth of sides in one step. Equilateral: (1 + sqrt(3) t) / 2, 1 for theta
/// = pi/6 (Theorem 2.2). Right and isosceles: (1 + t) / 2, 1 for theta = pi/4 (Theorem 2.8).
double equilateral_growth(double theta);
double right_isosceles_growth(double theta);

}  // namespace smoothfem
