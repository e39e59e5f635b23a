// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>

#include "smoothing/mesh/point.h"
#include "smoothing/second_order/bernstein.h"

namespace smoothfem {

struct JacobianTable;

/// det J of a curved cell as a polynomial in Bernstein form on the whole cell, in the collapsed
/// coordinates of shape_functions.h:
///
///   triangle              triangle, degree 2 (TRI7: 4)
///   quadrilateral         square, degrees 3, 3
///   tetrahedron           tetrahedron, degree 3
///   pyramid               cube, degrees 5, 5, 3
///   prism                 triangle, degree 4, times line, degree 5
///   hexahedron            cube, degrees 5, 5, 5
///
/// It is computed exactly up to rounding from its values at as many points. The cell is moved to
/// the origin and scaled by a power of two, so that no coordinate is greater than 1: numbers can
/// neither overflow nor, in cells that are not nearly flat, underflow.
template <int dim>
class JacobianPolynomial {
 public:
  /// points: of one row of midside_nodes.h. Throws InputError if no element has that many.
  explicit JacobianPolynomial(std::span<const Point<dim>> points);

  const BernsteinSpace& space() const;
  /// Returns the coefficients of det J / 2^exponent().
  std::span<const double> coefficients() const { return {coefficients_.data(), space().size()}; }
  int exponent() const { return exponent_; }
  /// Returns a bound of the rounding errors of all coefficients. It follows from the number of
  /// operations and their greatest possible operands. Infinite if a point is not finite.
  ///
  /// In relation to the product of the columns' lengths in J it is about 1e-12 for simplices and
  /// 3e-9 for hexahedra, the greatest.
  double error() const { return error_; }

  /// Returns the area or volume of the cell, negative if it is inverted: the integral of det J.
  double cell_size() const;

 private:
  static constexpr std::size_t max_coefficients = 216;

  const JacobianTable* table_;
  std::array<double, max_coefficients> coefficients_;
  double error_;
  int exponent_;
};

}  // namespace smoothfem
