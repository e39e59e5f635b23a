// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>

#include "fem/solvers/mesh_solver.h"
#include "smoothing/loop/problem.h"

namespace smoothfem {

/// Makes a solver that is initialized on the initial mesh. degree: of its finite elements; a solver
/// without degrees ignores it. Throws InputError for a degree that the solver does not have.
template <int dim>
using MakeMeshSolver = std::function<std::unique_ptr<MeshSolver<dim>>(int degree)>;

/// The problem of any solver with an energy or indicators, for solution-adaptive smoothers.
/// initial: the mesh that solvers are initialized on; its nodes and cells are those of the smoothed
/// meshes.
///
/// A solver has indicators of one kind, which both kinds of ProblemSolver return.
/// It has no tensors and second derivatives: these throw InputError. A failure on the first mesh is
/// thrown as SmootherFailure; on later ones the energy is infinite.
template <int dim>
std::shared_ptr<const Problem<dim>> make_solver_problem(const Mesh<dim>& initial,
                                                        MakeMeshSolver<dim> make);

}  // namespace smoothfem
