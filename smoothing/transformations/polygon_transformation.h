// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cassert>
#include <complex>
#include <numbers>
#include <span>

#include "smoothing/simd/vectors.h"

namespace smoothfem {

/// The regularizing transformation of planar n-gons (thesis, Section 2.3). Similar triangles with
/// base angle theta and subdivision ratio lambda stand on every side, and their apices are the new
/// nodes. A second half step does the same with reversed orientation. Linear, keeps the centroid,
/// commutes with similarities. The regular polygon is its dominant eigenpolygon for the parameters
/// used in smoothing, so that iterating it makes any n-gon regular.
class PolygonTransformation {
 public:
  /// lambda in (0, 1), theta in (0, pi/2) radians.
  PolygonTransformation(double lambda, double theta) {
    assert(lambda > 0.0 && lambda < 1.0 && theta > 0.0 && theta < std::numbers::pi / 2.0);
    const std::complex<double> w(lambda, (1.0 - lambda) * std::tan(theta));
    diagonal_ = std::norm(1.0 - w) + std::norm(w);
    const std::complex<double> previous = w * (1.0 - std::conj(w));
    real_ = previous.real();
    imaginary_ = previous.imag();
  }

  /// Transforms a polygon. result: as many points as polygon, at least three; must not overlap it.
  /// Both half steps together are a circulant matrix: `diagonal` for the node, w (1 - conj w) for
  /// the previous node and its conjugate for the next one (Eq. 2.29 with its conjugates).
  template <class Real, std::size_t extent>
  void apply(std::span<const Vector2<Real>, extent> polygon,
             std::span<Vector2<Real>, extent> result) const {
    const std::size_t n = polygon.size();
    for (std::size_t k = 0; k < n; ++k) {
      const auto& before = polygon[k == 0 ? n - 1 : k - 1];
      const auto& after = polygon[k + 1 == n ? 0 : k + 1];
      const auto sum = before + after, difference = before - after;
      result[k] = {diagonal_ * polygon[k].x + real_ * sum.x - imaginary_ * difference.y,
                   diagonal_ * polygon[k].y + real_ * sum.y + imaginary_ * difference.x};
    }
  }

  /// Transforms a polygon in space that need not be flat. A turn by 90 degrees becomes the cross
  /// product with a unit normal.
  template <std::size_t extent>
  void apply(Vector3<double> normal, std::span<const Vector3<double>, extent> polygon,
             std::span<Vector3<double>, extent> result) const {
    const std::size_t n = polygon.size();
    for (std::size_t k = 0; k < n; ++k) {
      const auto& before = polygon[k == 0 ? n - 1 : k - 1];
      const auto& after = polygon[k + 1 == n ? 0 : k + 1];
      result[k] = diagonal_ * polygon[k] + real_ * (before + after) +
                  imaginary_ * cross(normal, before - after);
    }
  }

 private:
  double diagonal_;
  double real_, imaginary_;  ///< of w (1 - conj w)
};

}  // namespace smoothfem
