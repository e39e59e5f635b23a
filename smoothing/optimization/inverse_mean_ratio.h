// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <limits>

#include "smoothing/quality/mean_ratio.h"

namespace smoothfem {

/// The linear map from the regular corner to a given one, as z -> a z + b conj(z) in the complex
/// plane: a turns and scales, b distorts. Singular values: |a| + |b| and |a| - |b|.
template <class Real>
struct CornerMap {
  Vector2<Real> a, b;

  /// Determinant of S = D W^-1; it has the sign of det D.
  Real determinant() const { return squared_length(a) - squared_length(b); }
};

/// Dependence of a corner's map on its nodes (corner, next, previous), as complex numbers: a =
/// sum_k weights[k] x_k and b = sum_k conj(weights[k]) x_k. products[i][j] = conj(weights[i])
/// weights[j].
struct CornerWeights {
  std::array<Vector2<double>, 3> weights;
  std::array<std::array<Vector2<double>, 3>, 3> products;
};

/// Returns a times b, and conj(a) times b, as complex numbers.
template <class A, class B>
inline Vector2<B> complex_product(Vector2<A> a, Vector2<B> b) {
  return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x};
}
template <class A, class B>
inline Vector2<B> conjugate_product(Vector2<A> a, Vector2<B> b) {
  return {a.x * b.x + a.y * b.y, a.x * b.y - a.y * b.x};
}

/// Returns the weights for a corner of a polygon with n >= 3 nodes. S = D W^-1 with D = (next -
/// corner, previous - corner), and W of the regular n-gon.
inline CornerWeights corner_weights(std::size_t n) {
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
inline CornerMap<Real> corner_map(const CornerWeights& corner, Vector2<Real> here,
                                  Vector2<Real> next, Vector2<Real> previous) {
  const auto& w = corner.weights;
  return {
      complex_product(w[0], here) + complex_product(w[1], next) + complex_product(w[2], previous),
      conjugate_product(w[0], here) + conjugate_product(w[1], next) +
          conjugate_product(w[2], previous)};
}

/// Inverse mean ratio f = (A + B) / (A - B) with A = |a|^2 and B = |b|^2, and the parts of its
/// derivatives. Gradient: (gradient_a a, gradient_b b). Hessian blocks: aa_one I + aa a a', ab a
/// b', bb_one I + bb b b'. Only aa_one is negative; without it the Hessian is positive
/// semidefinite. Requires a positive determinant.
template <class Real>
struct InverseMeanRatio {
  Real value;
  Real gradient_a, gradient_b;
  Real aa_one, aa, ab, bb_one, bb;

  explicit InverseMeanRatio(const CornerMap<Real>& map) {
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

/// Mean inverse mean ratio of a planar cell's corners; infinite if a corner's determinant is not
/// positive.
template <class Real, std::size_t extent>
inline Real mean_inverse_mean_ratio(std::span<const Vector2<Real>, extent> x) {
  const std::size_t n = x.size(), n_corners = n == 3 ? 1 : n;
  const RegularAngle regular = regular_interior_angle(n);
  const Real infinite = Real{} + std::numeric_limits<double>::infinity();
  Real sum{};
  for (std::size_t k = 0; k < n_corners; ++k) {
    const auto next = x[k + 1 == n ? 0 : k + 1] - x[k];
    const auto previous = x[k == 0 ? n - 1 : k - 1] - x[k];
    const Real determinant = cross(next, previous);
    const Real ratio = (squared_length(next) + squared_length(previous) -
                        2.0 * regular.cosine * dot(next, previous)) /
                       (2.0 * regular.sine * determinant);
    sum += determinant > 0.0 ? ratio : infinite;
  }
  return sum / static_cast<double>(n_corners);
}

/// Mean inverse mean ratio of a volume cell: |S|^2 / (3 det(S)^(2/3)), S = D W^-1, over the corners
/// that the mean ratio counts.
template <class Real, std::size_t n>
inline Real mean_inverse_mean_ratio(std::span<const Vector3<Real>, n> x) {
  constexpr std::size_t n_corners = VolumeElement<n>::corners.size();
  const Real infinite = Real{} + std::numeric_limits<double>::infinity();
  const CellEdges<Real, n> edges(x);
  Real sum{};
  unrolled<n_corners>([&](auto k) {
    const CornerShape<Real> shape = corner_shape<k>(edges);
    const Real root = inverse_root<3>(shape.determinant);
    sum += shape.determinant > 0.0 ? shape.squared_norm * (root * root) : infinite;
  });
  return sum * (1.0 / (3.0 * static_cast<double>(n_corners)));
}

/// Coefficients of |S|^2 = sum_ij corner_gram[i][j] x_i x_j with the four nodes of a corner, itself
/// first. They follow from the inverse Gram matrix of W, since |S|^2 does not change when all nodes
/// move alike.
template <std::size_t n>
inline constexpr auto corner_gram = [] {
  std::array<std::array<double, 4>, 4> gram{};
  for (std::size_t i = 1; i < 4; ++i)
    for (std::size_t j = 1; j < 4; ++j) {
      const double g = VolumeElement<n>::regular.inverse_gram[i - 1][j - 1];
      gram[i][j] = g;
      gram[i][0] -= g;
      gram[0][j] -= g;
      gram[0][0] += g;
    }
  return gram;
}();

/// Inverse mean ratio f of a volume corner, and the parts of its derivatives: the gradients of
/// |S|^2 / 2 and of log det(S) with respect to its four nodes. grad(f) = f (2 / |S|^2 times the
/// first - 2/3 of the second). Requires a positive determinant.
template <class Real>
struct CornerGradients {
  Real value;
  Real inverse_squared_norm;
  std::array<Vector3<Real>, 4> of_half_squared_norm, of_log_determinant;
};

template <std::size_t k, class Real, std::size_t n>
inline CornerGradients<Real> corner_gradients(std::span<const Vector3<Real>, n> x) {
  constexpr LocalSimplex corner = VolumeElement<n>::corners[k];
  constexpr auto& gram = corner_gram<n>;
  const std::array edges{x[corner[1]] - x[corner[0]], x[corner[2]] - x[corner[0]],
                         x[corner[3]] - x[corner[0]]};
  CornerGradients<Real> result;
  auto& u = result.of_half_squared_norm;
  auto& c = result.of_log_determinant;
  for (std::size_t i = 0; i < 4; ++i)
    u[i] = gram[i][1] * edges[0] + gram[i][2] * edges[1] + gram[i][3] * edges[2];
  for (std::size_t i = 0; i < 3; ++i) c[i + 1] = cross(edges[(i + 1) % 3], edges[(i + 2) % 3]);
  const Real determinant = dot(edges[0], c[1]);
  const Real squared_norm = dot(edges[0], u[1]) + dot(edges[1], u[2]) + dot(edges[2], u[3]);
  const Real root = inverse_root<3>((1.0 / VolumeElement<n>::regular.determinant) * determinant);
  const Real inverse = 1.0 / determinant;
  for (std::size_t i = 1; i < 4; ++i) c[i] = inverse * c[i];
  c[0] = -1.0 * (c[1] + c[2] + c[3]);
  result.value = (1.0 / 3.0) * squared_norm * (root * root);
  result.inverse_squared_norm = 1.0 / squared_norm;
  return result;
}

}  // namespace smoothfem
