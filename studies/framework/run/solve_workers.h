// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "studies/framework/run/solve_queue.h"
#include "studies/framework/run/solver_team.h"
#include "studies/framework/run/study_data.h"

namespace smoothfem {

/// The study's solution; expressions are checked at the points of `sample`.
template <int dim>
ManufacturedSolution<dim> study_solution(const StudySolution& solution,
                                         std::span<const Point<dim>> sample);

/// Workers for a queue of these tasks, whose outcomes are noted in the data and in its checkpoint.
/// Planar meshes: n_threads, each with its own solvers; volume meshes: one, which leads the team.
/// All arguments must outlive them.
std::vector<SolveQueue::Worker> solve_workers(StudyData<2>& data,
                                              const std::vector<SolveTask*>& tasks,
                                              unsigned int n_threads);
std::vector<SolveQueue::Worker> solve_workers(StudyData<3>& data,
                                              const std::vector<SolveTask*>& tasks,
                                              SolverTeam& team);

/// On ranks other than the root: takes part in the solves of a volume study until the root's team
/// ends.
void serve_solves(const Study& study, const Ranks& ranks);

}  // namespace smoothfem
