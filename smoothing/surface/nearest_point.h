// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// The nearest point to p of the segment from a to b.
template <int spacedim>
Point<spacedim> nearest_on_segment(const Point<spacedim>& p, const Point<spacedim>& a,
                                   const Point<spacedim>& b) {
  const Point<spacedim> along = b - a;
  const double square = along.squaredNorm();
  if (!(square > 0.0)) return a;
  return a + std::clamp((p - a).dot(along) / square, 0.0, 1.0) * along;
}

/// The nearest point to p of the triangle a, b, c: its foot in the triangle's plane if that lies
/// inside, otherwise the nearest one of the sides.
inline Point<3> nearest_on_triangle(const Point<3>& p, const Point<3>& a, const Point<3>& b,
                                    const Point<3>& c) {
  const Point<3> u = b - a, v = c - a, w = p - a;
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm();
  const double determinant = uu * vv - uv * uv;
  if (determinant > 0.0) {
    const double s = (vv * w.dot(u) - uv * w.dot(v)) / determinant;
    const double t = (uu * w.dot(v) - uv * w.dot(u)) / determinant;
    if (s >= 0.0 && t >= 0.0 && s + t <= 1.0) return a + s * u + t * v;
  }
  Point<3> nearest = nearest_on_segment(p, a, b);
  for (const Point<3>& other : {nearest_on_segment(p, b, c), nearest_on_segment(p, c, a)})
    if ((other - p).squaredNorm() < (nearest - p).squaredNorm()) nearest = other;
  return nearest;
}

}  // namespace smoothfem
