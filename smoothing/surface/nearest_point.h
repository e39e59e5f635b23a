// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>

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

/// Parameters s and t in [0, 1] of a bilinear surface: corner 0 has (0, 0), corner 1 (1, 0), corner
/// 2 (1, 1) and corner 3 (0, 1).
struct BilinearParameters {
  double s = 0.5, t = 0.5;

  Point<3> point(const std::array<Point<3>, 4>& x) const {
    return (1.0 - t) * ((1.0 - s) * x[0] + s * x[1]) + t * ((1.0 - s) * x[3] + s * x[2]);
  }
  /// Weights of the corners.
  std::array<double, 4> weights() const {
    return {(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t};
  }
};

/// Returns the parameters of a point of the bilinear surface with these corners: the nearest one to
/// p if p is near the surface. Refinement in a hexahedron makes nodes of this surface (Gauss-Newton
/// method).
inline BilinearParameters nearest_on_bilinear(const Point<3>& p, const std::array<Point<3>, 4>& x) {
  constexpr int max_steps = 20;
  BilinearParameters at;
  auto& [s, t] = at;
  for (int step = 0; step < max_steps; ++step) {
    const Point<3> along_s = (1.0 - t) * (x[1] - x[0]) + t * (x[2] - x[3]),
                   along_t = (1.0 - s) * (x[3] - x[0]) + s * (x[2] - x[1]), left = p - at.point(x);
    const double ss = dot<3>(along_s, along_s), st = dot<3>(along_s, along_t),
                 tt = dot<3>(along_t, along_t), determinant = ss * tt - st * st;
    if (!(determinant > 0.0)) break;
    const double by_s = dot<3>(left, along_s), by_t = dot<3>(left, along_t);
    s = std::clamp(s + (tt * by_s - st * by_t) / determinant, 0.0, 1.0);
    t = std::clamp(t + (ss * by_t - st * by_s) / determinant, 0.0, 1.0);
  }
  return at;
}

}  // namespace smoothfem
