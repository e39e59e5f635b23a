#pragma once

#include <array>

#include "smoothing/quality/mean_ratio.h"

namespace smoothfem {

/// The linear map that takes the regular corner to a given one, as z -> a z + b conj(z) of the
/// complex plane: a turns and scales, b distorts. Singular values |a| + |b| and |a| - |b|.
template <class Real>
struct CornerMap {
  Vector2<Real> a, b;

  /// Of S = D W^-1; same sign as that of det D.
  SMOOTHFEM_INLINE Real determinant() const { return squared_length(a) - squared_length(b); }
};

/// How a corner's map depends on its nodes (corner, next, previous): a = sum_k weights[k] x_k and b
/// = sum_k conj(weights[k]) x_k as complex numbers. products[i][j] = conj(weights[i]) weights[j].
struct CornerWeights {
  std::array<Vector2<double>, 3> weights;
  std::array<std::array<Vector2<double>, 3>, 3> products;
};

/// a times b, and conj(a) times b, as complex numbers.
template <class A, class B>
SMOOTHFEM_INLINE Vector2<B> complex_product(Vector2<A> a, Vector2<B> b) {
  return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x};
}
template <class A, class B>
SMOOTHFEM_INLINE Vector2<B> conjugate_product(Vector2<A> a, Vector2<B> b) {
  return {a.x * b.x + a.y * b.y, a.x * b.y - a.y * b.x};
}

/// For a corner of a polygon with n >= 3 nodes: S = D W^-1 with D = (next - corner, previous -
/// corner) and W of the regular n-gon.
SMOOTHFEM_INLINE CornerWeights corner_weights(std::size_t n) {
  const RegularAngle angle = regular_interior_angle(n);
  const double slope = angle.cosine / angle.sine, scale = 1.0 / angle.sine;
  CornerWeights corner;
  corner.weights = {{{-0.5, 0.5 * (scale - slope)}, {0.5, 0.5 * slope}, {0.0, -0.5 * scale}}};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      corner.products[i][j] = conjugate_product(corner.weights[i], corner.weights[j]);
  return corner;
}

template <class Real>
SMOOTHFEM_INLINE CornerMap<Real> corner_map(const CornerWeights& corner, Vector2<Real> here,
                                            Vector2<Real> next, Vector2<Real> previous) {
  const auto& w = corner.weights;
  return {
      complex_product(w[0], here) + complex_product(w[1], next) + complex_product(w[2], previous),
      conjugate_product(w[0], here) + conjugate_product(w[1], next) +
          conjugate_product(w[2], previous)};
}

/// Inverse mean ratio f = (A + B) / (A - B) with A = |a|^2 and B = |b|^2, and what its derivatives
/// are made of: gradient (gradient_a a, gradient_b b); Hessian blocks aa_one I + aa a a', ab a b',
/// bb_one I + bb b b'. Of these only aa_one is negative: without it the Hessian is positive
/// semidefinite. Requires a positive determinant.
template <class Real>
struct InverseMeanRatio {
  Real value;
  Real gradient_a, gradient_b;
  Real aa_one, aa, ab, bb_one, bb;

  SMOOTHFEM_INLINE explicit InverseMeanRatio(const CornerMap<Real>& map) {
    const Real big = squared_length(map.a), small = squared_length(map.b);
    const Real inverse = 1.0 / (big - small), sum = big + small;
    const Real four = 4.0 * inverse * inverse;
    value = sum * inverse;
    gradient_a = -(four * small);
    gradient_b = four * big;
    aa_one = gradient_a;
    bb_one = gradient_b;
    ab = -2.0 * four * inverse * sum;
    aa = 4.0 * four * inverse * small;
    bb = 4.0 * four * inverse * big;
  }
};

}  // namespace smoothfem
