// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "fem/solutions/manufactured_solution.h"

namespace smoothfem {

/// Returns "(0.500000, 1.000000)" for messages.
template <int dim>
std::string point_text(const Point<dim>& p) {
  std::string text;
  for (int d = 0; d < dim; ++d) text += (d == 0 ? "(" : ", ") + std::to_string(p[d]);
  return text + ")";
}

/// Names of the parts of a solution in a study, for messages.
struct SolutionKeys {
  const char *value, *gradient, *load;
  bool is_derived = false;  ///< gradient and load are derived from the value
};

/// Checks the parts of a solution at sample points (nodes of the mesh). Throws InputError that
/// names the first point where a part is not finite. Throws it also if gradient and load do not
/// belong to the value, compared with differences. The diffusivity must be symmetric and positive
/// definite.
template <int dim>
void check_solution(const ManufacturedSolution<dim>& solution, const SolutionKeys& keys,
                    std::span<const Point<dim>> sample);

}  // namespace smoothfem
