#pragma once

#include <Eigen/Core>
#include <array>

#include "smoothing/quality/mean_ratio.h"

namespace smoothfem {

/// Value and derivatives of the inverse mean ratio |S|^2 / (2 det S) of one corner with respect to
/// the columns of S = (s1, s2), that is to the vector (s1x, s1y, s2x, s2y).
struct InverseMeanRatio {
  double value;
  Eigen::Vector4d gradient;
  Eigen::Matrix4d hessian;
};

/// Requires det S > 0. With N = |S|^2, d = det S and g its gradient:
/// gradient s / d - N g / (2 d^2), Hessian I / d - (s g' + g s') / d^2 + N g g' / d^3 - N J / (2
/// d^2), J the constant Hessian of the determinant.
inline InverseMeanRatio inverse_mean_ratio(const Eigen::Vector4d& s) {
  const double norm = s.squaredNorm(), d = s[0] * s[3] - s[1] * s[2];
  const Eigen::Vector4d g(s[3], -s[2], -s[1], s[0]);
  const double inverse = 1.0 / d, inverse2 = inverse * inverse, half = 0.5 * norm * inverse2;
  InverseMeanRatio result;
  result.value = 0.5 * norm * inverse;
  result.gradient = inverse * s - half * g;
  result.hessian = (-inverse2 * s + norm * inverse2 * inverse * g) * g.transpose() -
                   inverse2 * g * s.transpose();
  result.hessian.diagonal().array() += inverse;
  result.hessian(0, 3) -= half;
  result.hessian(3, 0) -= half;
  result.hessian(1, 2) += half;
  result.hessian(2, 1) += half;
  return result;
}

/// How the columns of a corner's S depend on its nodes (corner, next, previous):
/// s1 = sum_k first[k] x_k, s2 = sum_k second[k] x_k.
struct CornerCoefficients {
  std::array<double, 3> first, second;
};

/// For a corner of a polygon with n >= 3 nodes: S = D W^-1 with D = (next - corner, previous -
/// corner) and W of the regular n-gon.
inline CornerCoefficients corner_coefficients(std::size_t n) {
  const RegularAngle angle = regular_interior_angle(n);
  const double slope = angle.cosine / angle.sine, scale = 1.0 / angle.sine;
  return {{-1.0, 1.0, 0.0}, {slope - scale, -slope, scale}};
}

}  // namespace smoothfem
