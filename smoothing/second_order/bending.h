// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "smoothing/optimization/cell_derivatives.h"
#include "smoothing/optimization/cell_sums.h"
#include "smoothing/second_order/reference_rules.h"

namespace smoothfem {

/// The nodes of one cell.
template <int dim>
struct CellNodes {
  std::vector<Vector<dim, double>> x;

  CellNodes(std::span<const NodeIndex> nodes, std::span<const Point<dim>> coordinates) {
    x.reserve(nodes.size());
    for (const NodeIndex i : nodes) x.push_back(vector_of(coordinates[i]));
  }
  explicit CellNodes(const std::vector<Point<dim>>& points) {
    x.reserve(points.size());
    for (const auto& point : points) x.push_back(vector_of(point));
  }
};

/// The bending b = mean(|S - S'|^2) / |mean(S)|^2 of a cell of second order (CellRule), a quotient
/// of two quadratic forms x'Mx / x'Kx in its nodes. It is 0 for straight cells.
template <int dim>
class Bending {
 public:
  Bending(const CellRule<dim>& rule, const CellNodes<dim>& nodes)
      : rule_(rule), of_form_(rule.n_nodes()), of_mean_(rule.n_nodes()) {
    const std::size_t n = rule.n_nodes();
    std::array<Vector<dim, double>, dim> mean{};
    for (std::size_t q = 0; q < n; ++q) {
      const auto x = nodes.x[q] - nodes.x[0];  // M and K have row sums 0
      for (std::size_t p = 0; p < n; ++p) of_form_[p] = of_form_[p] + rule.bending(p, q) * x;
      for (std::size_t d = 0; d < dim; ++d) mean[d] = mean[d] + rule.mean_gradient(q)[d] * x;
    }
    for (std::size_t p = 0; p < n; ++p) {
      form_ += dot(of_form_[p], nodes.x[p] - nodes.x[0]);
      for (std::size_t d = 0; d < dim; ++d)
        of_mean_[p] = of_mean_[p] + rule.mean_gradient(p)[d] * mean[d];
    }
    for (const auto& column : mean) squared_mean_ += squared_length(column);
  }

  double value() const { return form_ / squared_mean_; }

  /// Adds weight times the derivatives. With m = M x and k = K x, the gradient by node p is
  /// 2 (m_p - b k_p) / x'Kx, and the Hessian is 2 / x'Kx times
  ///
  ///   M - b K - 2 (m k' + k m') / x'Kx + 4 b k k' / x'Kx.
  ///
  /// The convex model is that of Gauss and Newton for b = |r|^2:
  ///
  ///   M - (m k' + k m') / x'Kx + b k k' / x'Kx.
  void add_derivatives(double weight, HessianModel model, HessianBlocks blocks,
                       std::vector<Vector<dim, double>>& gradient,
                       std::vector<Block<dim, double>>& hessian) const {
    const std::size_t n = rule_.n_nodes();
    const double b = value(), inverse = 1.0 / squared_mean_, factor = 2.0 * weight * inverse;
    const bool is_exact = model == HessianModel::exact;
    const double of_k = is_exact ? b : 0.0, of_mk = -(is_exact ? 2.0 : 1.0) * inverse,
                 of_kk = (is_exact ? 4.0 : 1.0) * b * inverse;
    for (std::size_t p = 0; p < n; ++p) {
      const auto m_p = of_form_[p], k_p = of_mean_[p];
      gradient[p] = gradient[p] + factor * (m_p - b * k_p);
      for (std::size_t q = p; q < (blocks == HessianBlocks::all ? n : p + 1); ++q) {
        const auto m_q = of_form_[q], k_q = of_mean_[q];
        Block<dim, double>& block = hessian[node_pair(n, p, q)];
        block.add_unit(factor * (rule_.bending(p, q) -
                                 of_k * rule_.mean_gradient(p).dot(rule_.mean_gradient(q))));
        block.add_product(factor * m_p, of_mk * k_q);
        block.add_product(factor * k_p, of_mk * m_q + of_kk * k_q);
      }
    }
  }

 private:
  const CellRule<dim>& rule_;
  std::vector<Vector<dim, double>> of_form_, of_mean_;  ///< M x and K x, by nodes
  double form_ = 0.0, squared_mean_ = 0.0;              ///< x'Mx and x'Kx
};

}  // namespace smoothfem
