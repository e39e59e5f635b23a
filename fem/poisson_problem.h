// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fem/manufactured_solution.h"
#include "smoothing/loop/problem.h"

namespace smoothfem {

/// -div(A grad u) = f for smoothers that move nodes by its solution. Of the manufactured solution
/// they get A, f and the boundary values only. Planar meshes are solved by a Cholesky
/// factorization, volume meshes by CG with algebraic multigrid, both far below the error.
/// natural_groups: see make_finite_element_space. Its solvers throw InputError, when they are
/// prepared, for boundary nodes that are not fixed, and as make_finite_element_space and Energy do.
template <int dim>
std::shared_ptr<const Problem<dim>> make_poisson_problem(
    ManufacturedSolution<dim> solution, std::vector<std::string> natural_groups = {});

/// Several of these on the same mesh, whose solutions count alike: see combined_solver. Each has a
/// matrix of its own, and is assembled and solved by itself. solutions: at least one; with one it
/// is the problem above.
template <int dim>
std::shared_ptr<const Problem<dim>> make_poisson_problem(
    std::vector<ManufacturedSolution<dim>> solutions, std::vector<std::string> natural_groups = {});

}  // namespace smoothfem
