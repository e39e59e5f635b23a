// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "studies/framework/run/solve_queue.h"
#include "studies/framework/run/solver_team.h"
#include "studies/framework/run/study_data.h"
#include "studies/framework/run/study_options.h"

namespace smoothfem {

/// Makes one of the study's solutions. Expressions are checked at the points of `sample`.
template <int dim>
ManufacturedSolution<dim> study_solution(const StudySolution& solution,
                                         std::span<const Point<dim>> sample);

/// Returns the formulas of u and of the diffusivity as text. The text of u of a named solution also
/// gives its diffusivity, if that is not the identity.
template <int dim>
std::string u_text(const StudySolution& solution);
std::string diffusivity_text(const StudySolution& solution);

/// True if a study needs MPI: meshes in parts, and solves with Trilinos, which are those on volume
/// meshes, multigrid, and some solvers.
bool needs_mpi(const Study& study);

/// Returns the number of records that are solved at once. Trilinos runs on one thread at a time.
unsigned int n_solve_workers(const Study& study, const StudyOptions& options);

/// Makes a solver that is not Poisson's, ready for meshes of one topology. Throws InputError if it
/// cannot be used on them; a SolverFailure if it fails. team: all of it takes part if the solver
/// takes ranks and the mesh has no ties; null: this process alone, as for planar meshes.
template <int dim>
std::unique_ptr<MeshSolver<dim>> solver_on_mesh(const StudyData<dim>& data, std::size_t mesh,
                                                const StudySolve& solve, SolverTeam* team);

/// Returns workers for a queue of these tasks. They store the results in the data and
/// keep them.
/// Planar meshes have n_workers workers, each with its own solvers. Volume meshes have one worker,
/// which leads the team. All arguments must outlive the workers.
std::vector<SolveQueue::Worker> solve_workers(StudyData<2>& data,
                                              const std::vector<SolveTask*>& tasks,
                                              unsigned int n_workers);
std::vector<SolveQueue::Worker> solve_workers(StudyData<3>& data,
                                              const std::vector<SolveTask*>& tasks,
                                              SolverTeam& team);

/// Returns the worker of a rank for meshes in parts. Each task is collective.
template <int dim>
SolveQueue::Worker solve_worker_in_parts(StudyData<dim>& data, const std::vector<SolveTask*>& tasks,
                                         const Ranks& ranks);

/// Takes part in the solves of a volume study, on ranks other than the root, until the root's team
/// ends.
void serve_solves(const Study& study, const Ranks& ranks);

}  // namespace smoothfem
