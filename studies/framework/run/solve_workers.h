// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "studies/framework/run/solve_queue.h"
#include "studies/framework/run/solver_team.h"
#include "studies/framework/run/study_data.h"
#include "studies/framework/run/study_options.h"

namespace smoothfem {

/// One of the study's solutions; expressions are checked at the points of `sample`.
template <int dim>
ManufacturedSolution<dim> study_solution(const StudySolution& solution,
                                         std::span<const Point<dim>> sample);

/// Whether a study's solves need Trilinos, and with it MPI: on volume meshes, and for multigrid.
bool needs_mpi(const Study& study);

/// How many of a study's records are solved at once. Trilinos is for one thread at a time.
unsigned int n_solve_workers(const Study& study, const StudyOptions& options);

/// Workers for a queue of these tasks, whose outcomes are noted in the data and in its checkpoint.
/// Planar meshes: n_workers, each with its own solvers; volume meshes: one, which leads the team.
/// All arguments must outlive them.
std::vector<SolveQueue::Worker> solve_workers(StudyData<2>& data,
                                              const std::vector<SolveTask*>& tasks,
                                              unsigned int n_workers);
std::vector<SolveQueue::Worker> solve_workers(StudyData<3>& data,
                                              const std::vector<SolveTask*>& tasks,
                                              SolverTeam& team);

/// On ranks other than the root: takes part in the solves of a volume study until the root's team
/// ends.
void serve_solves(const Study& study, const Ranks& ranks);

}  // namespace smoothfem
