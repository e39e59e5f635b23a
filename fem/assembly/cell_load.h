// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>

#include "fem/assembly/cell_integrals.h"

namespace smoothfem {

/// The integrals of f phi_i over a cell, and of |f phi_i|.
template <std::size_t n_dofs>
struct CellLoad {
  std::array<double, n_dofs> values{}, scales{};

  /// f_at: f at a position. weighted_f: receives f times the mapped weight of each of the table's
  /// points, unless it is null.
  template <int dim, std::size_t n_vertices>
  CellLoad(const QuadratureTable& table,
           const std::array<Vector<dim, double>, n_vertices>& vertices,
           const PointFunction<dim, double>& f_at, double* weighted_f = nullptr) {
    for_each_point(table, vertices, f_at, [&](std::size_t q, const auto& mapped, double f_here) {
      const double f = f_here * mapped.weight;
      if (weighted_f != nullptr) weighted_f[q] = f;
      for (std::size_t i = 0; i < n_dofs; ++i) {
        values[i] += f * table.shape[q * n_dofs + i];
        scales[i] += std::abs(f * table.shape[q * n_dofs + i]);
      }
    });
  }

  bool is_near(const CellLoad& finer, double tolerance) const {
    double change = 0.0, square = 0.0;
    for (std::size_t i = 0; i < n_dofs; ++i) {
      change += (finer.values[i] - values[i]) * (finer.values[i] - values[i]);
      square += finer.scales[i] * finer.scales[i];
    }
    return change <= tolerance * tolerance * square;
  }
};

}  // namespace smoothfem
