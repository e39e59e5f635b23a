// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/mesh/point.h"
#include "smoothing/simd/lanes.h"

namespace smoothfem {

/// A point or vector in the plane, of one cell or of several at a time (Real: double or Lanes).
template <class Real>
struct Vector2 {
  Real x, y;

  friend inline Vector2 operator+(Vector2 a, Vector2 b) { return {a.x + b.x, a.y + b.y}; }
  friend inline Vector2 operator-(Vector2 a, Vector2 b) { return {a.x - b.x, a.y - b.y}; }
  friend inline Vector2 operator*(Real s, Vector2 a) { return {s * a.x, s * a.y}; }
  friend inline Vector2 operator*(double s, Vector2 a) requires(!std::is_same_v<Real, double>) {
    return {s * a.x, s * a.y};
  }
  friend inline Vector2 operator/(Vector2 a, double s) { return {a.x / s, a.y / s}; }
  /// Broadcasts the subtracted point of the plane to each lane.
  friend inline Vector2 operator-(Vector2 a,
                                  Vector2<double> b) requires(!std::is_same_v<Real, double>) {
    return {a.x - b.x, a.y - b.y};
  }
};

/// A point or vector in space, of one cell or of several at a time.
template <class Real>
struct Vector3 {
  Real x, y, z;

  friend inline Vector3 operator+(Vector3 a, Vector3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend inline Vector3 operator-(Vector3 a, Vector3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend inline Vector3 operator*(Real s, Vector3 a) { return {s * a.x, s * a.y, s * a.z}; }
  friend inline Vector3 operator*(double s, Vector3 a) requires(!std::is_same_v<Real, double>) {
    return {s * a.x, s * a.y, s * a.z};
  }
  friend inline Vector3 operator/(Vector3 a, double s) { return {a.x / s, a.y / s, a.z / s}; }
  friend inline Vector3 operator-(Vector3 a,
                                  Vector3<double> b) requires(!std::is_same_v<Real, double>) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
};

template <int dim, class Real>
using Vector = std::conditional_t<dim == 2, Vector2<Real>, Vector3<Real>>;

template <class Real>
inline Real dot(Vector2<Real> a, Vector2<Real> b) {
  return a.x * b.x + a.y * b.y;
}
template <class Real>
inline Real dot(Vector3<Real> a, Vector3<Real> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
inline Real cross(Vector2<Real> a, Vector2<Real> b) {
  return a.x * b.y - a.y * b.x;
}
template <class Real>
inline Vector3<Real> cross(Vector3<Real> a, Vector3<Real> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Real>
inline Real determinant(Vector3<Real> a, Vector3<Real> b, Vector3<Real> c) {
  return dot(cross(a, b), c);
}
template <template <class> class V, class Real>
inline Real squared_length(V<Real> a) {
  return dot(a, a);
}
template <template <class> class V, class Real>
inline Real length(V<Real> a) {
  return square_root(squared_length(a));
}

/// Length of a vector whose squared length may overflow or underflow.
inline double length_of_any_size(Vector3<double> a) {
  constexpr double least = 0x1p-1000, largest = 0x1p1000;
  const double square = squared_length(a);
  if (square > least && square < largest) return square_root(square);
  return Eigen::Vector3d(a.x, a.y, a.z).stableNorm();
}

inline Vector2<double> vector_of(const Point<2>& p) {
  return {p.x(), p.y()};
}
inline Vector3<double> vector_of(const Point<3>& p) {
  return {p.x(), p.y(), p.z()};
}
inline Point<2> point_of(Vector2<double> v) {
  return {v.x, v.y};
}
inline Point<3> point_of(Vector3<double> v) {
  return {v.x, v.y, v.z};
}
inline double cross(const Point<2>& a, const Point<2>& b) {
  return cross(vector_of(a), vector_of(b));
}

/// Returns the point in one lane.
template <class Real>
inline Point<2> lane(Vector2<Real> v, std::size_t l) {
  return {lane(v.x, l), lane(v.y, l)};
}
template <class Real>
inline Point<3> lane(Vector3<Real> v, std::size_t l) {
  return {lane(v.x, l), lane(v.y, l), lane(v.z, l)};
}

/// Returns the sum of the first `count` lanes.
template <class Real>
inline Point<2> sum_of_lanes(Vector2<Real> v, std::size_t count) {
  return {sum_of_lanes(v.x, count), sum_of_lanes(v.y, count)};
}
template <class Real>
inline Point<3> sum_of_lanes(Vector3<Real> v, std::size_t count) {
  return {sum_of_lanes(v.x, count), sum_of_lanes(v.y, count), sum_of_lanes(v.z, count)};
}

}  // namespace smoothfem
