// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Returns the nearest point to p of the segment from a to b.
template <int spacedim>
Point<spacedim> nearest_on_segment(const Point<spacedim>& p, const Point<spacedim>& a,
                                   const Point<spacedim>& b) {
  const Point<spacedim> along = b - a;
  const double square = squared_length<spacedim>(along);
  if (!(square > 0.0)) return a;
  return a + std::clamp(dot<spacedim>(p - a, along) / square, 0.0, 1.0) * along;
}

/// Returns the nearest point to p of the triangle a, b, c: its foot in the triangle's plane if that
/// lies inside, otherwise the nearest point of the sides.
inline Point<3> nearest_on_triangle(const Point<3>& p, const Point<3>& a, const Point<3>& b,
                                    const Point<3>& c) {
  const Point<3> u = b - a, v = c - a, w = p - a;
  const double uu = dot<3>(u, u), uv = dot<3>(u, v), vv = dot<3>(v, v);
  const double determinant = uu * vv - uv * uv;
  if (determinant > 0.0) {
    const double s = (vv * dot<3>(w, u) - uv * dot<3>(w, v)) / determinant;
    const double t = (uu * dot<3>(w, v) - uv * dot<3>(w, u)) / determinant;
    if (s >= 0.0 && t >= 0.0 && s + t <= 1.0) return a + s * u + t * v;
  }
  Point<3> nearest = nearest_on_segment(p, a, b);
  for (const Point<3>& other : {nearest_on_segment(p, b, c), nearest_on_segment(p, c, a)})
    if (squared_length<3>(other - p) < squared_length<3>(nearest - p)) nearest = other;
  return nearest;
}

}  // namespace smoothfem
