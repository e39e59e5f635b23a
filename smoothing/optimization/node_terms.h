// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/optimization/cell_derivatives.h"

namespace smoothfem {

/// A corner of a cell in any dimension: the dim edges from it, |S|^2 as a quadratic form of them
/// (the inverse Gram matrix of W) and the determinant of W.
template <int dim, class Real>
struct CornerFrame {
  std::array<Vector<dim, Real>, dim> edges;
  std::array<std::array<double, dim>, dim> inverse_gram;
  double regular_determinant;

  /// Half the gradient of |S|^2 with respect to the end of edge i.
  Vector<dim, Real> half_gradient(std::size_t i) const {
    auto sum = inverse_gram[i][0] * edges[0];
    for (std::size_t j = 1; j < dim; ++j) sum = sum + inverse_gram[i][j] * edges[j];
    return sum;
  }
};

/// Calls visit(frame, position) for the corners that the mean ratio counts. position: that of node
/// `slot` in the corner (0: the corner itself, then its neighbours), or -1 if it is not in the
/// corner. Planar cells have it as their first node.
template <std::size_t slot, class Real, std::size_t extent, class Visit>
inline void for_each_corner(std::span<const Vector2<Real>, extent> x, const Visit& visit) {
  static_assert(slot == 0);
  const std::size_t n = x.size(), n_corners = n == 3 ? 1 : n;
  const RegularAngle angle = regular_interior_angle(n);
  const double g = 1.0 / (angle.sine * angle.sine), mixed = -angle.cosine * g;
  for (std::size_t k = 0; k < n_corners; ++k) {
    const std::size_t next = k + 1 == n ? 0 : k + 1, previous = k == 0 ? n - 1 : k - 1;
    visit(
        CornerFrame<2, Real>{
            {x[next] - x[k], x[previous] - x[k]}, {{{g, mixed}, {mixed, g}}}, angle.sine},
        k == 0          ? 0
        : next == 0     ? 1
        : previous == 0 ? 2
                        : -1);
  }
}
template <std::size_t slot, class Real, std::size_t n, class Visit>
inline void for_each_corner(std::span<const Vector3<Real>, n> x, const Visit& visit) {
  using Element = VolumeElement<n>;
  unrolled<Element::corners.size()>([&](auto k) {
    constexpr LocalSimplex corner = Element::corners[k];
    int position = -1;
    for (int j = 0; j < 4; ++j)
      if (corner[j] == slot) position = j;
    visit(CornerFrame<3, Real>{{x[corner[1]] - x[corner[0]], x[corner[2]] - x[corner[0]],
                                x[corner[3]] - x[corner[0]]},
                               Element::regular.inverse_gram,
                               Element::regular.determinant},
          position);
  });
}

template <class Real>
inline Real frame_determinant(const std::array<Vector2<Real>, 2>& e) {
  return cross(e[0], e[1]);
}
template <class Real>
inline Real frame_determinant(const std::array<Vector3<Real>, 3>& e) {
  return dot(e[0], cross(e[1], e[2]));
}
/// Gradient of the determinant with respect to the end of edge i.
template <class Real>
inline Vector2<Real> cofactor(const std::array<Vector2<Real>, 2>& e, std::size_t i) {
  return i == 0 ? Vector2<Real>{e[1].y, -e[1].x} : Vector2<Real>{-e[0].y, e[0].x};
}
template <class Real>
inline Vector3<Real> cofactor(const std::array<Vector3<Real>, 3>& e, std::size_t i) {
  return cross(e[(i + 1) % 3], e[(i + 2) % 3]);
}

/// h = m^2 of a cell as a function of the position of one of its nodes. m is the mean over the
/// corners of |S|^2 / (dim r^(2/dim)). If `softness` is zero, r is det(S), and h is infinite for an
/// invalid cell. Otherwise r = (det(S) + sqrt(det(S)^2 + 4 softness^2)) / 2, which is positive for
/// inverted corners, too (Escobar et al., Comput. Methods Appl. Mech. Engrg. 192 (2003)). With
/// softness zero h is convex in the position of one node, since determinants are linear in it, and
/// the Hessian is exact. Otherwise the Hessian is raised to be positive semidefinite.
template <int dim, class Real>
struct NodeTerms {
  Real value{};
  Vector<dim, Real> gradient{};
  Block<dim, Real> hessian{};
};

/// Returns r^(-2/dim).
template <int dim, class Real>
inline Real shape_power(Real r) {
  if constexpr (dim == 2) {
    return 1.0 / r;
  } else {
    const Real root = inverse_root<3>(r);
    return root * root;
  }
}

template <std::size_t slot, bool with_derivatives, template <class> class V, class Real,
          std::size_t extent>
inline auto node_terms(std::span<const V<Real>, extent> x, double softness) {
  constexpr int dim = sizeof(V<Real>) / sizeof(Real);
  constexpr double p = 2.0 / dim;
  const Real infinite = Real{} + std::numeric_limits<double>::infinity();
  NodeTerms<dim, Real> terms;
  double n_corners = 0.0;
  for_each_corner<slot>(x, [&](const CornerFrame<dim, Real>& corner, int position) {
    const auto& e = corner.edges;
    std::array<Vector<dim, Real>, dim> u;  // gradient of |S|^2 / 2 by the edges
    Real squared_norm{};
    for (std::size_t i = 0; i < dim; ++i) {
      u[i] = corner.half_gradient(i);
      squared_norm += dot(e[i], u[i]);
    }
    const double scale = 1.0 / corner.regular_determinant;
    const Real determinant = scale * frame_determinant(e);
    const Real regularized_root =
        softness > 0.0 ? square_root(determinant * determinant + (4.0 * softness * softness))
                       : determinant;
    const Real stable_branch = (2.0 * softness * softness) / (regularized_root - determinant);
    const Real r = determinant > 0.0 ? 0.5 * (determinant + regularized_root) : stable_branch;
    const Real power = shape_power<dim>(softness > 0.0 || determinant > 0.0 ? r : Real{} + 1.0);
    const Real factor = (1.0 / dim) * power;
    terms.value += softness > 0.0 || determinant > 0.0 ? factor * squared_norm : infinite;
    n_corners += 1.0;
    if (!with_derivatives || position < 0) return;

    Vector<dim, Real> half_gradient{}, of_determinant{};
    double gram = 0.0;
    for (std::size_t i = 0; i < dim; ++i) {
      if (position == 0) {
        half_gradient = half_gradient - u[i];
        of_determinant = of_determinant - cofactor(e, i);
        for (std::size_t j = 0; j < dim; ++j) gram += corner.inverse_gram[i][j];
      } else if (position == static_cast<int>(i) + 1) {
        half_gradient = u[i];
        of_determinant = cofactor(e, i);
        gram = corner.inverse_gram[i][i];
      }
    }
    const Real inverse = scale / regularized_root;
    const auto log_slope = inverse * of_determinant;
    const Real curvature = p * p + p * determinant / regularized_root;
    const Real least = Real{} + 2.0 * p * p;
    const Real value = factor * squared_norm;
    const auto slope = (2.0 * factor) * half_gradient;
    terms.gradient = terms.gradient + slope - (p * value) * log_slope;
    terms.hessian.add_unit((2.0 * gram) * factor);
    terms.hessian.add_product((-p) * slope, log_slope);
    terms.hessian.add_product(
        log_slope, (-p) * slope + ((curvature > least ? curvature : least) * value) * log_slope);
  });
  const double mean = 1.0 / n_corners;
  const Real m = mean * terms.value;
  if constexpr (with_derivatives) {
    for (auto& entry : terms.hessian.entries) entry *= (2.0 * mean) * m;
    terms.hessian.add_product((2.0 * mean * mean) * terms.gradient, terms.gradient);
    terms.gradient = ((2.0 * mean) * m) * terms.gradient;
  }
  terms.value = m * m;
  return terms;
}

}  // namespace smoothfem
