// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <utility>

#include "smoothing/mesh/point.h"

namespace smoothfem {

/// A quadratic segment, triangle or quadrilateral in space: the image of a reference domain under
/// the shape functions of its nodes (smoothing/second_order/shape_functions.h). The segment has the
/// reference domain [0, 1].
class QuadraticPiece {
 public:
  /// nodes: the ends and the middle of a segment, or the nodes of TRI6, TRI7, QUAD8 or QUAD9.
  explicit QuadraticPiece(std::span<const Point<3>> nodes);

  /// Returns the nearest point to p, by Newton's method. Where several points are nearly as near,
  /// it may be any of these.
  Point<3> nearest(const Point<3>& p) const;

  /// Returns the unit normal in the middle of side k, which begins at corner k.
  Point<3> normal_at_side(std::size_t k) const;

  /// Returns the corners of a box around the piece.
  const std::pair<Point<3>, Point<3>>& box() const { return box_; }

 private:
  static constexpr std::size_t n_powers = 3;
  enum class Kind { segment, triangle, quadrilateral };
  /// Position and derivatives at (u, v).
  struct Jet {
    Point<3> x, u, v, uu, uv, vv;
  };

  Jet at(double u, double v) const;
  void improve(const Point<3>& p, double u, double v, Point<3>& best) const;
  void set_box(std::span<const Point<3>> nodes);

  Kind kind_;
  std::array<Point<3>, n_powers * n_powers> coefficients_;  ///< of u^i v^j at i + 3 j
  std::array<Point<3>, 9> starts_;                          ///< points where the search may begin
  std::array<std::pair<double, double>, 9> start_at_;
  std::size_t n_starts_ = 0;
  std::pair<Point<3>, Point<3>> box_;
};

}  // namespace smoothfem
