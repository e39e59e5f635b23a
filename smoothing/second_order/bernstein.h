// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "smoothing/mesh/compressed_rows.h"
#include "smoothing/mesh/point.h"

namespace smoothfem {

/// The unit simplex (line, triangle or tetrahedron) of a dimension, and a degree up to 5.
struct BernsteinFactor {
  int dim, degree;
};

/// Polynomials on a product of unit simplices with up to three coordinates, of a degree for each
/// factor, in the Bernstein basis. The basis functions are nonnegative and their sum is 1. So the
/// least and the greatest coefficient bound the values. Coefficients at the corners are values
/// there.
///
/// A simplex has the vertices 0 (the origin) to dim (on the axes). Coefficients are ordered like
/// the points of a lattice: the first coordinate runs fastest, and the first factor.
class BernsteinSpace {
 public:
  /// A cut of the domain through the middle of an edge of one factor: the positions of all
  /// coefficients, in rows along that edge, from the first half to the second.
  using Split = CompressedRows<std::uint32_t>;

  explicit BernsteinSpace(std::vector<BernsteinFactor> factors);

  std::size_t size() const { return points_.size(); }
  /// Returns points whose values determine the coefficients, in the order of these.
  const std::vector<Point<3>>& points() const { return points_; }
  /// Returns the positions of the coefficients at the corners of the domain.
  const std::vector<std::size_t>& corners() const { return corners_; }
  const std::vector<Split>& splits() const { return splits_; }

  /// Replaces a polynomial's values at the points by its coefficients.
  void to_coefficients(std::span<double> values) const;
  /// Bound of the coefficients of polynomials with absolute values up to 1 at the points.
  double conversion_norm() const { return conversion_norm_; }
  /// Bound of the error of to_coefficients(), relative to the largest absolute value: rounding of
  /// sums and of the matrices' entries.
  double conversion_error() const { return conversion_error_; }

  /// Returns the value at a point.
  double value(std::span<const double> coefficients, const Point<3>& x) const;

  /// Computes the coefficients on both halves by de Casteljau's algorithm. Each is a mean of
  /// means, up to bisection_steps() times. `first` may be `coefficients` itself.
  void bisect(const Split& split, std::span<const double> coefficients, std::span<double> first,
              std::span<double> second) const;
  int bisection_steps() const;

  /// Returns the split along whose lines the coefficients deviate most from straight lines. These
  /// deviations bound the distance between coefficients and values. A split divides them by 4.
  const Split& best_split(std::span<const double> coefficients) const;

 private:
  struct Factor {
    BernsteinFactor shape;
    std::vector<std::array<int, 4>> indices;  ///< multi-indices; entry i belongs to vertex i
    /// Coefficient i from value j, at j * row + i. Rows are as long as whole Lanes.
    std::vector<double> conversion;
    std::size_t row;
    std::size_t stride;  ///< distance of its consecutive coefficients
  };
  static Factor make_factor(BernsteinFactor shape, std::size_t stride);
  void add_splits(const Factor& factor);

  std::vector<Factor> factors_;
  std::vector<Point<3>> points_;
  std::vector<std::size_t> corners_;
  std::vector<Split> splits_;
  double conversion_norm_ = 1.0, conversion_error_ = 0.0;
};

}  // namespace smoothfem
