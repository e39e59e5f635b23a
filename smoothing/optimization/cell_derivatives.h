// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "smoothing/optimization/inverse_mean_ratio.h"

namespace smoothfem {

/// A dim x dim matrix, by columns: the coupling of two nodes of a cell.
template <int dim, class Real>
struct Block {
  std::array<Real, static_cast<std::size_t>(dim* dim)> entries{};

  /// Adds u v'.
  void add_product(Vector2<Real> u, Vector2<Real> v) {
    entries[0] += u.x * v.x;
    entries[1] += u.y * v.x;
    entries[2] += u.x * v.y;
    entries[3] += u.y * v.y;
  }
  void add_product(Vector3<Real> u, Vector3<Real> v) {
    const std::array a{u.x, u.y, u.z}, b{v.x, v.y, v.z};
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i) entries[3 * j + i] += a[i] * b[j];
  }
  /// Adds a multiple of the unit matrix.
  void add_unit(Real scale) {
    for (std::size_t i = 0; i < dim; ++i) entries[(dim + 1) * i] += scale;
  }
};

/// Arrays for the n nodes (or pairs of nodes) of a cell; on the stack if n is known at compile
/// time.
template <class T, std::size_t extent>
struct CellArray : std::array<T, extent> {
  explicit CellArray(std::size_t) { this->fill(T{}); }
};
template <class T>
struct CellArray<T, std::dynamic_extent> : std::vector<T> {
  explicit CellArray(std::size_t n) : std::vector<T>(n) {}
};

/// Number of pairs p <= q of the n nodes of a cell, and the position of one pair.
constexpr std::size_t n_node_pairs(std::size_t n) {
  return n == std::dynamic_extent ? n : n * (n + 1) / 2;
}
constexpr std::size_t node_pair(std::size_t n, std::size_t p, std::size_t q) {
  return p * n - p * (p + 1) / 2 + q;
}

/// Model for the Hessian of an element's h = m^2, with m its mean inverse mean ratio.
enum class HessianModel {
  exact,
  /// positive semidefinite; each CellDerivatives describes the parts that it leaves out
  convex
};

/// Blocks of a cell's Hessian to compute.
enum class HessianBlocks { diagonal, all };

/// Gradient and Hessian of one cell's h. The gradient has an entry for each node. The Hessian has a
/// block for each pair of nodes p <= q (the others are their transposes), or for each p = q only.
template <int dim, class Real, std::size_t extent>
class CellDerivatives;

/// Derivatives of a planar cell. The convex model is h times the Hessian of log h without its
/// concave part. It equals the exact Hessian at a regular element. Near a collapsed element h grows
/// like 1 / det^2: there an exact Newton step increases the determinant by a third, and this model
/// doubles it.
template <class Real, std::size_t extent>
class CellDerivatives<2, Real, extent> {
 public:
  using NodeBlocks = CellArray<Block<2, Real>, extent>;  ///< one block for each node

  CellArray<Vector2<Real>, extent> gradient;
  CellArray<Block<2, Real>, n_node_pairs(extent)> hessian;

  /// x: the n corners of a valid cell.
  CellDerivatives(std::span<const Vector2<Real>, extent> x, HessianModel model,
                  HessianBlocks blocks = HessianBlocks::all)
      : gradient(x.size()), hessian(n_node_pairs(x.size())), n_(x.size()), blocks_(blocks) {
    const CornerWeights weights = corner_weights(n_);
    const std::size_t n_corners = n_ == 3 ? 1 : n_;  // all corners of a triangle are equal
    const double weight = 1.0 / static_cast<double>(n_corners);
    const double concave_part = model == HessianModel::exact ? 1.0 : 0.0;
    Real mean{};
    for (std::size_t k = 0; k < n_corners; ++k) mean += value_of(map_of(x, weights, k));
    mean = weight * mean;
    for (std::size_t k = 0; k < n_corners; ++k)
      add_corner(map_of(x, weights, k), weights, k, 2.0 * weight * mean, concave_part);
    // So far the blocks hold 2 m Hess(m). h adds 2 grad(m) grad(m)', h Hess(log h) subtracts it.
    const Real factor = (model == HessianModel::exact ? 0.5 : -0.5) / (mean * mean);
    for (std::size_t p = 0; p < n_; ++p)
      for (std::size_t q = p; q < (blocks == HessianBlocks::all ? n_ : p + 1); ++q)
        hessian[node_pair(n_, p, q)].add_product(factor * gradient[p], gradient[q]);
  }

 private:
  std::size_t next(std::size_t k) const { return k + 1 == n_ ? 0 : k + 1; }
  std::size_t previous(std::size_t k) const { return k == 0 ? n_ - 1 : k - 1; }

  static inline Real value_of(const CornerMap<Real>& map) {
    return (squared_length(map.a) + squared_length(map.b)) / map.determinant();
  }
  CornerMap<Real> map_of(std::span<const Vector2<Real>, extent> x, const CornerWeights& weights,
                         std::size_t k) const {
    return corner_map(weights, x[k], x[next(k)], x[previous(k)]);
  }

  void add_corner(const CornerMap<Real>& map, const CornerWeights& weights, std::size_t k,
                  Real scale, double concave_part) {
    const InverseMeanRatio<Real> f(map);
    const std::array nodes{k, next(k), previous(k)};
    const Real aa = scale * f.aa, ab = scale * f.ab, bb = scale * f.bb;
    const Real gradient_a = scale * f.gradient_a, gradient_b = scale * f.gradient_b;
    const Real aa_one = concave_part * scale * f.aa_one, bb_one = scale * f.bb_one;
    // The position of a node changes a by its weight and b by the conjugate: rows of the chain
    // rule.
    std::array<Vector2<Real>, 3> u, v, hu, hv;
    for (std::size_t i = 0; i < 3; ++i) {
      u[i] = conjugate_product(weights.weights[i], map.a);
      v[i] = complex_product(weights.weights[i], map.b);
      hu[i] = aa * u[i] + ab * v[i];
      hv[i] = ab * u[i] + bb * v[i];
      gradient[nodes[i]] = gradient[nodes[i]] + gradient_a * u[i] + gradient_b * v[i];
    }
    const Real even = aa_one + bb_one, odd = aa_one - bb_one;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        if (nodes[i] > nodes[j] || (i != j && blocks_ == HessianBlocks::diagonal)) continue;
        auto& block = hessian[node_pair(n_, nodes[i], nodes[j])];
        block.add_product(u[i], hu[j]);
        block.add_product(v[i], hv[j]);
        const Real real = even * weights.products[i][j].x;
        const Real imaginary = odd * weights.products[i][j].y;
        block.entries[0] += real;
        block.entries[1] += imaginary;
        block.entries[2] -= imaginary;
        block.entries[3] += real;
      }
  }

  std::size_t n_;
  HessianBlocks blocks_;
};

}  // namespace smoothfem
