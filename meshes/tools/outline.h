// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "smoothing/base/input_error.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A piece of a boundary. point(t), t in [0, 1], moves along it with constant speed.
struct Curve {
  double length;
  std::function<Point<2>(double)> point;
};

/// A closed outline: each curve ends where the next one begins, the last where the first begins.
using Outline = std::vector<Curve>;

/// The outer polygon first, followed by the holes; all counterclockwise.
using Polygons = std::vector<std::vector<Point<2>>>;

Point<2> on_circle(const Point<2>& centre, double radius, double angle);

Curve segment(const Point<2>& from, const Point<2>& to);
/// Arc from angle `from` to angle `to`, clockwise if `to` is smaller.
Curve arc(const Point<2>& centre, double radius, double from, double to);
/// Polyline through two or more different points.
Curve polyline(std::vector<Point<2>> points);

/// Polygon with these corners.
Outline closed(const std::vector<Point<2>>& corners);
Outline circle(const Point<2>& centre, double radius);

/// Error of `divide`: the curves need at least n_least edges.
struct TooFewEdges : InputError {
  TooFewEdges(const std::string& message, std::size_t wanted, std::size_t least,
              std::size_t multiple)
      : InputError(message),
        n_edges(wanted),
        n_least(least),
        multiple_of(static_cast<double>(multiple)) {}

  std::size_t n_edges, n_least;
  double multiple_of;
};

/// Returns closed polygons with n_edges edges altogether, of nearly equal length, with a multiple
/// of `multiple_of` on each curve. at: position of the points along the edges; 0.5 gives, instead
/// of the corners, the points of the curves in the middle between them. Throws InputError if that
/// is not possible, TooFewEdges if n_edges is too small.
Polygons divide(const std::vector<Outline>& outlines, std::size_t n_edges, std::size_t multiple_of,
                double at = 0.0);

/// Area inside the first polygon and outside the others.
double area(const Polygons& polygons);

}  // namespace smoothfem
