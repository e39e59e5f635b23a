// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/loop/parameter.h"
#include "smoothing/loop/problem.h"

namespace smoothfem {

enum IndicatorKind { recovery, residual };

/// The parameter that chooses between them.
inline Parameter indicator_choice(int* indicator) {
  return {"indicator",
          "what tells where the error is large: the gradient against a recovered one (Zienkiewicz, "
          "Zhu 1987), or the residual with the gradient's jumps (Kelly et al. 1983)",
          Choice{indicator, {"recovery", "residual"}}};
}

/// Of each cell, of the last solve.
template <int dim>
std::vector<double> error_indicators(const ProblemSolver<dim>& solver, int indicator) {
  return indicator == recovery ? solver.recovery_indicators() : solver.residual_indicators();
}

}  // namespace smoothfem
