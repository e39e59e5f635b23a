// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fem/adaptivity/energy_solver.h"
#include "smoothing/loop/problem.h"

namespace smoothfem {

/// The problem -div(A grad u) = f for solution-adaptive smoothers, which get only A, f and the
/// boundary values of the manufactured solution. For the method of solution see EnergySolver.
/// natural_groups: see make_finite_element_space. When its solvers are prepared they throw
/// InputError for boundary nodes that are not fixed, and as make_energy_solver does.
template <int dim>
std::shared_ptr<const Problem<dim>> make_poisson_problem(
    ManufacturedSolution<dim> solution, std::vector<std::string> natural_groups = {});

/// Several such problems on the same mesh with equal weights of their solutions (see
/// combined_solver). Each has its own matrix and is assembled and solved separately. solutions: at
/// least one; with one it is the problem above.
template <int dim>
std::shared_ptr<const Problem<dim>> make_poisson_problem(
    std::vector<ManufacturedSolution<dim>> solutions, std::vector<std::string> natural_groups = {});

/// Makes the solver of one of a problem's solutions, by its number among them, for meshes of a
/// topology.
template <int dim>
using MakeEnergySolver = std::function<std::unique_ptr<EnergySolver<dim>>(
    const Mesh<dim>& mesh, int degree, std::size_t solution)>;

/// Makes the problem with given solvers, for example those of several ranks, which the root
/// controls.
template <int dim>
std::shared_ptr<const Problem<dim>> make_poisson_problem(
    std::vector<ManufacturedSolution<dim>> solutions, MakeEnergySolver<dim> make);

}  // namespace smoothfem
