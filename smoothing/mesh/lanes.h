#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "smoothing/mesh/mesh.h"

/// Geometry formulas are written once, as templates over the number type Real: double for one cell,
/// Lanes for several cells of one type at a time. Both give the same bits for each cell, because
/// they are the same operations in the same order, none of them contracted.
///
/// SMOOTHFEM_VECTOR_CLONES before a function compiles it for wider registers too; which one runs is
/// chosen when the program is loaded. What it calls must be inlined to profit: SMOOTHFEM_INLINE.
#if defined(__x86_64__) && defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__)
#define SMOOTHFEM_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define SMOOTHFEM_VECTOR_CLONES
#endif
#define SMOOTHFEM_INLINE_LAMBDA __attribute__((always_inline))
#define SMOOTHFEM_INLINE SMOOTHFEM_INLINE_LAMBDA inline

namespace smoothfem {

constexpr std::size_t n_lanes = 4;
/// For local variables only: code for wider registers expects more alignment of it than
/// std::vector<Lanes> has. Arrays are kept as double (load_lanes).
using Lanes = double __attribute__((vector_size(n_lanes * sizeof(double))));

/// n_lanes numbers from and to an array of double, on any address. (With std::memcpy GCC goes by
/// way of the stack.)
SMOOTHFEM_INLINE Lanes load_lanes(const double* numbers) {
  using Unaligned =
      double __attribute__((vector_size(sizeof(Lanes)), aligned(sizeof(double)), may_alias));
  return *reinterpret_cast<const Unaligned*>(numbers);
}
SMOOTHFEM_INLINE void store_lanes(Lanes lanes, double* numbers) {
  using Unaligned =
      double __attribute__((vector_size(sizeof(Lanes)), aligned(sizeof(double)), may_alias));
  *reinterpret_cast<Unaligned*>(numbers) = lanes;
}

SMOOTHFEM_INLINE double square_root(double value) {
  return std::sqrt(value);
}
SMOOTHFEM_INLINE Lanes square_root(Lanes value) {
  return Lanes{std::sqrt(value[0]), std::sqrt(value[1]), std::sqrt(value[2]), std::sqrt(value[3])};
}

/// A point or vector of the plane.
template <class Real>
struct Vector2 {
  Real x, y;

  friend SMOOTHFEM_INLINE Vector2 operator+(Vector2 a, Vector2 b) { return {a.x + b.x, a.y + b.y}; }
  friend SMOOTHFEM_INLINE Vector2 operator-(Vector2 a, Vector2 b) { return {a.x - b.x, a.y - b.y}; }
  friend SMOOTHFEM_INLINE Vector2 operator*(Real s, Vector2 a) { return {s * a.x, s * a.y}; }
  friend SMOOTHFEM_INLINE Vector2 operator*(double s,
                                            Vector2 a) requires(!std::is_same_v<Real, double>) {
    return {s * a.x, s * a.y};
  }
};

template <class Real>
SMOOTHFEM_INLINE Real dot(Vector2<Real> a, Vector2<Real> b) {
  return a.x * b.x + a.y * b.y;
}
template <class Real>
SMOOTHFEM_INLINE Real cross(Vector2<Real> a, Vector2<Real> b) {
  return a.x * b.y - a.y * b.x;
}
template <class Real>
SMOOTHFEM_INLINE Real squared_length(Vector2<Real> a) {
  return dot(a, a);
}
template <class Real>
SMOOTHFEM_INLINE Real length(Vector2<Real> a) {
  return square_root(squared_length(a));
}

SMOOTHFEM_INLINE Vector2<double> vector_of(const Point<2>& p) {
  return {p.x(), p.y()};
}
SMOOTHFEM_INLINE Point<2> point_of(Vector2<double> v) {
  return {v.x, v.y};
}
SMOOTHFEM_INLINE double cross(const Point<2>& a, const Point<2>& b) {
  return cross(vector_of(a), vector_of(b));
}

/// The k-th corners of n_lanes cells, given by their rows of nodes.
SMOOTHFEM_INLINE Vector2<Lanes> gather_corner(const Point<2>* x,
                                              const std::array<const NodeIndex*, n_lanes>& rows,
                                              std::size_t k) {
  const auto &a = x[rows[0][k]], &b = x[rows[1][k]], &c = x[rows[2][k]], &d = x[rows[3][k]];
  return {Lanes{a.x(), b.x(), c.x(), d.x()}, Lanes{a.y(), b.y(), c.y(), d.y()}};
}

}  // namespace smoothfem
