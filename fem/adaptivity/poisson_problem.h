// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fem/adaptivity/energy_solver.h"
#include "smoothing/loop/problem.h"

namespace smoothfem {

/// -div(A grad u) = f for smoothers that move nodes by its solution. Of the manufactured solution
/// they get A, f and the boundary values only. How it is solved: see EnergySolver. natural_groups:
/// see make_finite_element_space. Its solvers throw InputError, when they are prepared, for
/// boundary nodes that are not fixed, and as make_energy_solver does.
template <int dim>
std::shared_ptr<const Problem<dim>> make_poisson_problem(
    ManufacturedSolution<dim> solution, std::vector<std::string> natural_groups = {});

/// Several of these on the same mesh, whose solutions count alike: see combined_solver. Each has a
/// matrix of its own, and is assembled and solved by itself. solutions: at least one; with one it
/// is the problem above.
template <int dim>
std::shared_ptr<const Problem<dim>> make_poisson_problem(
    std::vector<ManufacturedSolution<dim>> solutions, std::vector<std::string> natural_groups = {});

/// Makes the solver of one of a problem's solutions, by its number among them, for meshes of a
/// topology.
template <int dim>
using MakeEnergySolver = std::function<std::unique_ptr<EnergySolver<dim>>(
    const Mesh<dim>& mesh, int degree, std::size_t solution)>;

/// The same by solvers that come from elsewhere, as from several ranks, whose root asks.
template <int dim>
std::shared_ptr<const Problem<dim>> make_poisson_problem(
    std::vector<ManufacturedSolution<dim>> solutions, MakeEnergySolver<dim> make);

}  // namespace smoothfem
