// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/optimization/volume_cell_derivatives.h"
#include "smoothing/quality/target_corners.h"
#include "smoothing/transformations/scaling.h"

namespace smoothfem {

/// Size part of the objective of cells with targets: w g(t), g(t) = (t + 1 / t) / 2 - 1, with the
/// cell's size t relative to its target, a mean of determinants. It is zero for the target's size,
/// and infinite for cells without size. Source: metrics of size, Knupp (2012), and of shape and
/// size in Dobrev et al., SIAM J. Sci. Comput. 41 (2019).
template <class Real>
inline Real size_term(Real t) {
  const Real infinite = Real{} + std::numeric_limits<double>::infinity();
  return t > 0.0 ? 0.5 * (t + 1.0 / t) - 1.0 : infinite;
}

/// First and second derivative of g.
template <class Real>
struct SizeTermDerivatives {
  Real first, second;
  explicit SizeTermDerivatives(Real t) {
    const Real inverse = 1.0 / t;
    first = 0.5 * (1.0 - inverse * inverse);
    second = inverse * inverse * inverse;
  }
};

/// Derivatives of a cell's size, the mean of its corners' determinants.
template <int dim, class Real, std::size_t extent>
class SizeDerivatives {
 public:
  /// x: corners of a valid cell, mapped to where the target is regular.
  explicit SizeDerivatives(std::span<const Vector<dim, Real>, extent> x)
      : gradient(x.size()), n_(x.size()) {
    visit_corners([&](const auto& nodes, double weight) { add_gradient(x, nodes, weight); });
  }

  CellArray<Vector<dim, Real>, extent> gradient;  ///< of the cell's size by each node

  /// Adds `scale` times the size's Hessian to the blocks of pairs p < q (it has no others).
  template <class Blocks>
  void add_hessian(std::span<const Vector<dim, Real>, extent> x, Real scale, Blocks& blocks) const {
    visit_corners([&](const auto& nodes, double weight) {
      add_corner_hessian(x, nodes, weight * scale, blocks);
    });
  }

 private:
  /// Calls visit(nodes, weight) for each corner: itself and its neighbours.
  template <class Visit>
  void visit_corners(const Visit& visit) const {
    if constexpr (dim == 2) {
      const std::size_t n_corners = n_ == 3 ? 1 : n_;
      for (std::size_t k = 0; k < n_corners; ++k)
        visit(std::array<std::size_t, 3>{k, k + 1 == n_ ? 0 : k + 1, k == 0 ? n_ - 1 : k - 1},
              1.0 / static_cast<double>(n_corners));
    } else {
      for (const LocalSimplex& corner : VolumeElement<extent>::corners)
        visit(std::array<std::size_t, 4>{corner[0], corner[1], corner[2], corner[3]},
              1.0 / static_cast<double>(VolumeElement<extent>::corners.size()));
    }
  }

  /// The rotation J with u' J v = u x v in the plane.
  static Vector2<Real> turned(Vector2<Real> v) { return {v.y, -v.x}; }

  void add_gradient(std::span<const Vector2<Real>, extent> x,
                    const std::array<std::size_t, 3>& nodes, double weight) {
    const auto u = x[nodes[1]] - x[nodes[0]], v = x[nodes[2]] - x[nodes[0]];
    add_edges(nodes, std::array{weight * turned(v), -weight * turned(u)});
  }
  void add_gradient(std::span<const Vector3<Real>, extent> x,
                    const std::array<std::size_t, 4>& nodes, double weight) {
    const auto u = x[nodes[1]] - x[nodes[0]], v = x[nodes[2]] - x[nodes[0]],
               w = x[nodes[3]] - x[nodes[0]];
    add_edges(nodes, std::array{weight * cross(v, w), weight * cross(w, u), weight * cross(u, v)});
  }
  /// Adds derivatives by the edges from a corner to its neighbours.
  template <std::size_t n_nodes, class V>
  void add_edges(const std::array<std::size_t, n_nodes>& nodes,
                 const std::array<V, n_nodes - 1>& of_edges) {
    for (std::size_t i = 0; i + 1 < n_nodes; ++i) {
      gradient[nodes[i + 1]] = gradient[nodes[i + 1]] + of_edges[i];
      gradient[nodes[0]] = gradient[nodes[0]] - of_edges[i];
    }
  }

  template <class Blocks>
  void add_corner_hessian(std::span<const Vector2<Real>, extent>,
                          const std::array<std::size_t, 3>& nodes, Real scale,
                          Blocks& blocks) const {
    Block<2, Real> turn;
    turn.entries = {Real{}, -scale, scale, Real{}};
    add_edge_pair(nodes, 1, 2, turn, blocks);
  }
  template <class Blocks>
  void add_corner_hessian(std::span<const Vector3<Real>, extent> x,
                          const std::array<std::size_t, 4>& nodes, Real scale,
                          Blocks& blocks) const {
    const auto edge = [&](std::size_t k) { return x[nodes[k]] - x[nodes[0]]; };
    add_edge_pair(nodes, 1, 2, cross_block(scale * edge(3)), blocks);
    add_edge_pair(nodes, 2, 3, cross_block(scale * edge(1)), blocks);
    add_edge_pair(nodes, 3, 1, cross_block(scale * edge(2)), blocks);
  }
  /// Returns a with u' a v = det(u, v, w).
  static Block<3, Real> cross_block(Vector3<Real> w) {
    Block<3, Real> a;
    a.entries = {Real{}, -w.z, w.y, w.z, Real{}, -w.x, -w.y, w.x, Real{}};
    return a;
  }
  /// Adds the second derivative u' a v of two edges; a is skew. The edges are those from the corner
  /// to its neighbours i and j.
  template <std::size_t n_nodes, class Blocks>
  void add_edge_pair(const std::array<std::size_t, n_nodes>& nodes, std::size_t i, std::size_t j,
                     const Block<dim, Real>& a, Blocks& blocks) const {
    add_pair(nodes[i], nodes[j], 1.0, a, blocks);
    add_pair(nodes[i], nodes[0], -1.0, a, blocks);
    add_pair(nodes[0], nodes[j], -1.0, a, blocks);
  }
  /// Adds sign * a to the block of nodes p, q. The transpose of a is -a.
  template <class Blocks>
  void add_pair(std::size_t p, std::size_t q, double sign, const Block<dim, Real>& a,
                Blocks& blocks) const {
    auto& block = blocks[p < q ? node_pair(n_, p, q) : node_pair(n_, q, p)];
    const double factor = p < q ? sign : -sign;
    for (std::size_t e = 0; e < a.entries.size(); ++e) block.entries[e] += factor * a.entries[e];
  }

  std::size_t n_;
};

/// Changes derivatives by corners that were mapped by `map` to those by the corners themselves.
template <int dim, class Real, std::size_t extent>
void map_back(const LinearMap<dim, Real>& map, CellDerivatives<dim, Real, extent>& cell,
              HessianBlocks blocks) {
  const LinearMap<dim, Real> transposed = map.transposed();
  const std::size_t n = cell.gradient.size();
  for (std::size_t p = 0; p < n; ++p) {
    cell.gradient[p] = transposed(cell.gradient[p]);
    for (std::size_t q = p; q < (blocks == HessianBlocks::all ? n : p + 1); ++q) {
      auto& entries = cell.hessian[node_pair(n, p, q)].entries;
      LinearMap<dim, Real> once, twice;  // block * map, then map' * that
      for (std::size_t j = 0; j < dim; ++j)
        for (std::size_t i = 0; i < dim; ++i) {
          once.m[dim * j + i] = Real{};
          for (std::size_t k = 0; k < dim; ++k)
            once.m[dim * j + i] += entries[dim * k + i] * map.m[dim * j + k];
        }
      for (std::size_t j = 0; j < dim; ++j)
        for (std::size_t i = 0; i < dim; ++i) {
          twice.m[dim * j + i] = Real{};
          for (std::size_t k = 0; k < dim; ++k)
            twice.m[dim * j + i] += transposed.m[dim * k + i] * once.m[dim * j + k];
        }
      for (std::size_t e = 0; e < entries.size(); ++e) entries[e] = twice.m[e];
    }
  }
}

/// Adds `weight` times the size term's derivatives to those of a cell's shape, then maps them back.
/// x: corners where the target is regular; map: there. The convex model leaves out the
/// determinants' second derivatives.
template <int dim, class Real, std::size_t extent>
void add_size_and_map_back(std::span<const Vector<dim, Real>, extent> x, double weight,
                           const LinearMap<dim, Real>& map, HessianModel model,
                           HessianBlocks blocks, CellDerivatives<dim, Real, extent>& cell) {
  const std::size_t n = x.size();
  const SizeDerivatives<dim, Real, extent> size(x);
  const SizeTermDerivatives<Real> g(node_simplex_size<dim>(x));
  for (std::size_t p = 0; p < n; ++p) {
    cell.gradient[p] = cell.gradient[p] + (weight * g.first) * size.gradient[p];
    for (std::size_t q = p; q < (blocks == HessianBlocks::all ? n : p + 1); ++q)
      cell.hessian[node_pair(n, p, q)].add_product((weight * g.second) * size.gradient[p],
                                                   size.gradient[q]);
  }
  if (model == HessianModel::exact && blocks == HessianBlocks::all)
    size.add_hessian(x, weight * g.first, cell.hessian);
  map_back(map, cell, blocks);
}

}  // namespace smoothfem
