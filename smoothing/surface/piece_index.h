// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "smoothing/surface/nearest_point.h"
#include "smoothing/surface/quadratic_piece.h"

namespace smoothfem {

/// A triangle of a smooth part, or a segment (c = b) of a feature line; or a curved piece.
struct Piece {
  Point<3> a, b, c;
  std::uint32_t part;
  std::shared_ptr<const QuadraticPiece> curved = {};

  Point<3> nearest(const Point<3>& p) const {
    if (curved) return curved->nearest(p);
    return c == b ? nearest_on_segment(p, a, b) : nearest_on_triangle(p, a, b, c);
  }
};

/// Finds pieces by their boxes. Uses Boost's R-tree instead of VTK's locator: it needs only
/// headers, and a search can skip the pieces of other parts of the surface.
class PieceIndex {
 public:
  explicit PieceIndex(std::vector<Piece> pieces) : pieces_(std::move(pieces)), tree_(entries()) {}

  /// Returns the nearest point to p on the pieces of a part, or of all. Searches a box of size
  /// `radius` first, which meets every piece within `radius`; a larger box if no piece is as near.
  Point<3> nearest(const Point<3>& p, std::optional<std::uint32_t> part, double radius) const {
    Point<3> best = p;
    for (double best_square = infinite; best_square > radius * radius; radius *= 2.0) {
      best_square = infinite;
      std::uint32_t best_piece = 0;
      const auto look_at = [&](const Entry& entry) {
        const Piece& piece = pieces_[entry.second];
        if (part && piece.part != *part) return;
        const Point<3> point = piece.nearest(p);
        const double square = squared_length<3>(point - p);
        const bool tie = square == best_square && entry.second < best_piece;
        if (!(square < best_square || tie)) return;
        best = point;
        best_square = square;
        best_piece = entry.second;
      };
      tree_.query(boost::geometry::index::intersects(box_around(p, radius)),
                  boost::make_function_output_iterator(std::ref(look_at)));
    }
    return best;
  }

  /// Returns the longest side of the box around all pieces.
  double extent() const {
    const Box box = tree_.bounds();
    return std::max({box.max_corner().get<0>() - box.min_corner().get<0>(),
                     box.max_corner().get<1>() - box.min_corner().get<1>(),
                     box.max_corner().get<2>() - box.min_corner().get<2>()});
  }

 private:
  using Corner = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
  using Box = boost::geometry::model::box<Corner>;
  using Entry = std::pair<Box, std::uint32_t>;
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  static Box box_between(const Point<3>& low, const Point<3>& high) {
    return {Corner(low.x(), low.y(), low.z()), Corner(high.x(), high.y(), high.z())};
  }
  static Box box_around(const Point<3>& p, double radius) {
    const Point<3> half = Point<3>::Constant(radius);
    return box_between(p - half, p + half);
  }
  std::vector<Entry> entries() const {
    std::vector<Entry> all;
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
      const Piece& p = pieces_[i];
      all.emplace_back(
          p.curved ? box_between(p.curved->box().first, p.curved->box().second)
                   : box_between(p.a.cwiseMin(p.b).cwiseMin(p.c), p.a.cwiseMax(p.b).cwiseMax(p.c)),
          i);
    }
    return all;
  }

  std::vector<Piece> pieces_;
  boost::geometry::index::rtree<Entry, boost::geometry::index::rstar<16>> tree_;
};

}  // namespace smoothfem
