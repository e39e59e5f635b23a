// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "smoothing/second_order/jacobian_polynomial.h"

/// Proven bounds of det J in curved cells: Johnen, Remacle and Geuzaine, Geometrical validity of
/// curvilinear finite elements, J. Comput. Phys. 233 (2013), doi 10.1016/j.jcp.2012.08.051. The
/// least Bernstein coefficient is a lower bound of the minimum. Values at corners are upper bounds.
/// Halves of the cell have better bounds. The half with the lowest bound is cut again, until the
/// bounds suffice, but at most max_bisections times. All bounds include rounding errors.
///
/// points, for all functions: the nodes of one cell, in the order of midside_nodes.h. Bad numbers
/// of points throw InputError.

namespace smoothfem {

inline constexpr int max_bisections = 1000;

struct Interval {
  double lower, upper;
};

/// Intervals that contain the minimum and the maximum of det J over a cell.
struct JacobianBounds {
  Interval minimum, maximum;
};

/// True if det J is proven to be positive in the whole closed cell: a lower bound of it minus the
/// bound of rounding errors is positive. False if it is not positive somewhere or nearly so, if
/// max_bisections do not decide, and for points that are not finite.
template <int dim>
bool is_proven_valid(const JacobianPolynomial<dim>& jacobian);
template <int dim>
bool is_proven_valid(std::span<const Point<dim>> points);

/// Returns bounds. Their distance is at most `tolerance` times the largest |det J| plus rounding
/// errors, unless max_bisections are not enough. tolerance >= 0. Infinite bounds for points that
/// are not finite. The polynomial's bounds are in its unit, 2^exponent().
template <int dim>
JacobianBounds jacobian_bounds(const JacobianPolynomial<dim>& jacobian, double tolerance);
template <int dim>
JacobianBounds jacobian_bounds(std::span<const Point<dim>> points, double tolerance);

}  // namespace smoothfem
