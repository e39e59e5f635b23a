#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "smoothing/mesh/mesh.h"

/// Geometry formulas are written once, as templates over the number type Real: double for one cell,
/// Lanes for several cells of one type at a time. Both give the same bits for each cell, because
/// they are the same operations in the same order, none of them contracted.
#define SMOOTHFEM_INLINE_LAMBDA __attribute__((always_inline))
#define SMOOTHFEM_INLINE SMOOTHFEM_INLINE_LAMBDA inline

namespace smoothfem {

constexpr std::size_t n_lanes = 4;
/// For local variables only: code for wider registers expects more alignment of it than
/// std::vector<Lanes> has. Arrays are kept as double (load_lanes).
using Lanes = double __attribute__((vector_size(n_lanes * sizeof(double))));
using LaneBits = std::uint64_t __attribute__((vector_size(n_lanes * sizeof(std::uint64_t))));

/// The outcome of comparing Lanes.
using LaneMask = std::int64_t __attribute__((vector_size(n_lanes * sizeof(std::int64_t))));

/// Calls visit(std::integral_constant<std::size_t, i>{}) for i = 0 .. n-1: a loop that is unrolled
/// in any case, in which i can choose from constant tables at compile time.
template <std::size_t n, class Visit>
SMOOTHFEM_INLINE void unrolled(const Visit& visit) {
  [&]<std::size_t... i>(std::index_sequence<i...>) SMOOTHFEM_INLINE_LAMBDA {
    (visit(std::integral_constant<std::size_t, i>{}), ...);
  }
  (std::make_index_sequence<n>{});
}

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
/// As many numbers of single precision.
using FloatLanes = float __attribute__((vector_size(n_lanes * sizeof(float))));
SMOOTHFEM_INLINE FloatLanes load_lanes(const float* numbers) {
  using Unaligned =
      float __attribute__((vector_size(sizeof(FloatLanes)), aligned(sizeof(float)), may_alias));
  return *reinterpret_cast<const Unaligned*>(numbers);
}
SMOOTHFEM_INLINE void store_lanes(FloatLanes lanes, float* numbers) {
  using Unaligned =
      float __attribute__((vector_size(sizeof(FloatLanes)), aligned(sizeof(float)), may_alias));
  *reinterpret_cast<Unaligned*>(numbers) = lanes;
}

SMOOTHFEM_INLINE double square_root(double value) {
  return std::sqrt(value);
}
SMOOTHFEM_INLINE Lanes square_root(Lanes value) {
  return Lanes{std::sqrt(value[0]), std::sqrt(value[1]), std::sqrt(value[2]), std::sqrt(value[3])};
}

/// Four vectors of lanes, entry by entry, as one vector of four entries for each lane.
template <class AnyLanes>
SMOOTHFEM_INLINE std::array<AnyLanes, n_lanes> transposed(AnyLanes a, AnyLanes b, AnyLanes c,
                                                          AnyLanes d) {
  const AnyLanes even_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const AnyLanes odd_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const AnyLanes even_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const AnyLanes odd_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return {__builtin_shufflevector(even_ab, even_cd, 0, 1, 4, 5),
          __builtin_shufflevector(odd_ab, odd_cd, 0, 1, 4, 5),
          __builtin_shufflevector(even_ab, even_cd, 2, 3, 6, 7),
          __builtin_shufflevector(odd_ab, odd_cd, 2, 3, 6, 7)};
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

/// A point or vector of space.
template <class Real>
struct Vector3 {
  Real x, y, z;

  friend SMOOTHFEM_INLINE Vector3 operator+(Vector3 a, Vector3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend SMOOTHFEM_INLINE Vector3 operator-(Vector3 a, Vector3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend SMOOTHFEM_INLINE Vector3 operator*(Real s, Vector3 a) {
    return {s * a.x, s * a.y, s * a.z};
  }
  friend SMOOTHFEM_INLINE Vector3 operator*(double s,
                                            Vector3 a) requires(!std::is_same_v<Real, double>) {
    return {s * a.x, s * a.y, s * a.z};
  }
};

template <int dim, class Real>
using Vector = std::conditional_t<dim == 2, Vector2<Real>, Vector3<Real>>;

template <class Real>
SMOOTHFEM_INLINE Real dot(Vector2<Real> a, Vector2<Real> b) {
  return a.x * b.x + a.y * b.y;
}
template <class Real>
SMOOTHFEM_INLINE Real dot(Vector3<Real> a, Vector3<Real> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
SMOOTHFEM_INLINE Real cross(Vector2<Real> a, Vector2<Real> b) {
  return a.x * b.y - a.y * b.x;
}
template <class Real>
SMOOTHFEM_INLINE Vector3<Real> cross(Vector3<Real> a, Vector3<Real> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Real>
SMOOTHFEM_INLINE Real determinant(Vector3<Real> a, Vector3<Real> b, Vector3<Real> c) {
  return dot(cross(a, b), c);
}
template <template <class> class V, class Real>
SMOOTHFEM_INLINE Real squared_length(V<Real> a) {
  return dot(a, a);
}
template <template <class> class V, class Real>
SMOOTHFEM_INLINE Real length(V<Real> a) {
  return square_root(squared_length(a));
}

SMOOTHFEM_INLINE Vector2<double> vector_of(const Point<2>& p) {
  return {p.x(), p.y()};
}
SMOOTHFEM_INLINE Vector3<double> vector_of(const Point<3>& p) {
  return {p.x(), p.y(), p.z()};
}
SMOOTHFEM_INLINE Point<2> point_of(Vector2<double> v) {
  return {v.x, v.y};
}
SMOOTHFEM_INLINE Point<3> point_of(Vector3<double> v) {
  return {v.x, v.y, v.z};
}
SMOOTHFEM_INLINE double cross(const Point<2>& a, const Point<2>& b) {
  return cross(vector_of(a), vector_of(b));
}

/// The k-th corners of n_lanes cells, given by their rows of nodes. place_of(node): its
/// coordinates.
template <int dim, class PlaceOf>
SMOOTHFEM_INLINE Vector<dim, Lanes> gather_corner(const PlaceOf& place_of,
                                                  const std::array<const NodeIndex*, n_lanes>& rows,
                                                  std::size_t k) {
  const Point<dim>&a = place_of(rows[0][k]), &b = place_of(rows[1][k]), &c = place_of(rows[2][k]),
        &d = place_of(rows[3][k]);
  if constexpr (dim == 2)
    return {Lanes{a.x(), b.x(), c.x(), d.x()}, Lanes{a.y(), b.y(), c.y(), d.y()}};
  else
    return {Lanes{a.x(), b.x(), c.x(), d.x()}, Lanes{a.y(), b.y(), c.y(), d.y()},
            Lanes{a.z(), b.z(), c.z(), d.z()}};
}

}  // namespace smoothfem
