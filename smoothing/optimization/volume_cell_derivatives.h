// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/optimization/cell_derivatives.h"

namespace smoothfem {

/// Gradient and Hessian of one volume cell. With S = D W^-1 of a corner, its inverse mean ratio is
/// f = |S|^2 / (3 det(S)^(2/3)), a convex function of S and det(S). So f's Hessian is convex but
/// for the part with the second derivative of det(S). That part couples different nodes only (a
/// determinant is linear in the coordinates of each node) and depends little on shape: its sum over
/// equally large elements vanishes.
///
/// The convex model leaves that part out, but for a bound: f / 6 times |dS S^-1|^2, the strain of
/// the current element. The bound limits steps to lengths where first derivatives describe the
/// determinants. Without it Newton steps almost vanish near collapsed elements. The model also
/// leaves out 5/9 of grad(m) grad(m)', with m the mean of the f's, for longer steps there. This is
/// the largest part that keeps the sum positive semidefinite (as 5/18 of grad(f) grad(f)' / f does
/// at each corner).
template <class Real, std::size_t n>
class CellDerivatives<3, Real, n> {
 public:
  using NodeBlocks = CellArray<Block<3, Real>, n>;  ///< one block for each node

  std::array<Vector3<Real>, n> gradient{};
  std::array<Block<3, Real>, n_node_pairs(n)> hessian{};

  /// x: the nodes of a valid cell.
  CellDerivatives(std::span<const Vector3<Real>, n> x, HessianModel model,
                  HessianBlocks blocks = HessianBlocks::all) {
    constexpr std::size_t n_corners = VolumeElement<n>::corners.size();
    const Real mean = mean_inverse_mean_ratio(x);
    const Real scale = (2.0 / static_cast<double>(n_corners)) * mean;
    unrolled<n_corners>([&](auto k) { add_corner<k>(x, scale, model, blocks); });
    // So far the blocks hold 2 m Hess(m). grad(h) = 2 m grad(m), and h adds 2 grad(m) grad(m)'.
    const Real factor = (model == HessianModel::exact ? 0.5 : -5.0 / 36.0) / (mean * mean);
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t q = p; q < (blocks == HessianBlocks::all ? n : p + 1); ++q)
        hessian[node_pair(n, p, q)].add_product(factor * gradient[p], gradient[q]);
  }

 private:
  /// Adds `scale` times the derivatives of the inverse mean ratio of corner k.
  template <std::size_t k>
  void add_corner(std::span<const Vector3<Real>, n> x, Real scale, HessianModel model,
                  HessianBlocks blocks) {
    const CornerGradients<Real> corner = corner_gradients<k>(x);
    const auto& u = corner.of_half_squared_norm;
    const auto& c = corner.of_log_determinant;
    const Real value = scale * corner.value;
    const Real unit = 2.0 * value * corner.inverse_squared_norm, mixed = (-2.0 / 3.0) * unit;
    const Real slope = (-2.0 / 3.0) * value, square = (10.0 / 9.0) * value;
    constexpr LocalSimplex local_nodes = VolumeElement<n>::corners[k];
    std::array<Vector3<Real>, 4> a, b;
    for (std::size_t i = 0; i < 4; ++i) {
      a[i] = mixed * u[i];
      b[i] = a[i] + square * c[i];
      gradient[local_nodes[i]] = gradient[local_nodes[i]] + (unit * u[i] + slope * c[i]);
    }
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        if (local_nodes[i] > local_nodes[j] || (i != j && blocks == HessianBlocks::diagonal))
          continue;
        auto& block = hessian[node_pair(n, local_nodes[i], local_nodes[j])];
        block.add_product(a[i], c[j]);
        block.add_product(c[i], b[j]);
        if (corner_gram<n>[i][j] != 0.0) block.add_unit(corner_gram<n>[i][j] * unit);
        if (model == HessianModel::convex)
          block.add_unit(((1.0 / 6.0) * value) * dot(c[i], c[j]));
        else if (i != j)
          add_cross_product(((2.0 / 3.0) * value) * cross(c[i], c[j]), block);
      }
  }

  /// Adds the matrix of the map v -> w x v.
  static inline void add_cross_product(Vector3<Real> w, Block<3, Real>& block) {
    auto& m = block.entries;
    m[1] += w.z;
    m[2] -= w.y;
    m[3] -= w.z;
    m[5] += w.x;
    m[6] += w.y;
    m[7] -= w.x;
  }
};

}  // namespace smoothfem
