// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <vector>

#include "smoothing/geometry/cell_size.h"
#include "smoothing/loop/parameter.h"
#include "smoothing/loop/problem.h"

namespace smoothfem {

enum IndicatorKind { recovery, residual };

/// Parameter that chooses the indicator.
inline Parameter indicator_choice(int* indicator) {
  return {"indicator",
          "error indicator: the gradient compared with a recovered one (Zienkiewicz, "
          "Zhu 1987), or the residual with the gradient's jumps (Kelly et al. 1983)",
          Choice{indicator, {"recovery", "residual"}}};
}

/// Returns the indicator of each cell, of the last solve.
template <int dim>
std::vector<double> error_indicators(const ProblemSolver<dim>& solver, int indicator) {
  return indicator == recovery ? solver.recovery_indicators() : solver.residual_indicators();
}

/// Returns the area or volume of each cell.
template <int dim>
std::vector<double> cell_sizes(const Mesh<dim>& mesh) {
  std::vector<double> sizes(mesh.n_cells());
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) sizes[c] = std::abs(signed_cell_size(mesh, c));
  return sizes;
}

/// Returns the recovery's estimate of |grad(u - u_h)|^2; mesh: that of the last solve.
template <int dim>
double estimated_squared_error(const Mesh<dim>& mesh, const ProblemSolver<dim>& solver) {
  const auto errors = solver.recovery_indicators();
  const auto sizes = cell_sizes(mesh);
  double square = 0.0;
  for (CellIndex c = 0; c < sizes.size(); ++c) square += sizes[c] * errors[c] * errors[c];
  return square;
}

}  // namespace smoothfem
