// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "fem/solutions/manufactured_solution.h"

namespace smoothfem {

/// How a study calls the parts of a solution, for messages.
struct SolutionKeys {
  const char *value, *gradient, *load;
  bool is_derived = false;  ///< gradient and load come from the value
};

/// Throws InputError that names the first point where a part of the solution is not finite, where
/// gradient and load are not those of the value (against differences of it), or where the
/// diffusivity is not symmetric and positive definite. sample: nodes of the mesh.
template <int dim>
void check_solution(const ManufacturedSolution<dim>& solution, const SolutionKeys& keys,
                    std::span<const Point<dim>> sample);

}  // namespace smoothfem
