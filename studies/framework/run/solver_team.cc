// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/solver_team.h"

#include <chrono>
#include <cstdio>
#include <thread>

namespace smoothfem {

namespace {

enum class Task : int { make_solver, solve, nodal_errors, eigenvectors, set_eigenvectors, stop };

struct Command {
  Task task = Task::stop;
  int degree = 0;
  int is_result = 0;
  std::size_t solution = 0;
};

/// Waiting in MPI would keep a core busy that smoothing may need.
void wait_without_spinning(MPI_Request& request) {
  int done = 0;
  for (MPI_Test(&request, &done, MPI_STATUS_IGNORE); !done;
       MPI_Test(&request, &done, MPI_STATUS_IGNORE))
    std::this_thread::sleep_for(std::chrono::microseconds(500));
}

void exchange(const Ranks& ranks, Command& command) {
  if (ranks.size() == 1) return;
  MPI_Request request;
  MPI_Ibcast(&command, sizeof(command), MPI_BYTE, 0, ranks.communicator(), &request);
  wait_without_spinning(request);
}

/// What all ranks do alike may end in the same InputError on each. Anything else has hit one of
/// them, and the others wait for it for ever.
template <class Work>
auto all_or_nothing(const Ranks& ranks, const Work& work) {
  try {
    return work();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    if (ranks.size() == 1) throw;
    std::fprintf(stderr,
                 "smoothfem: process %d of %d failed (%s); the study goes on where it was "
                 "if you start it again\n",
                 ranks.rank(), ranks.size(), error.what());
    MPI_Abort(ranks.communicator(), 1);
    throw;
  }
}

}  // namespace

SolverTeam::~SolverTeam() {
  Command command{.task = Task::stop};
  exchange(ranks_, command);
}

void SolverTeam::make_solver(const Mesh<3>& mesh, const PoissonOptions& options) {
  Command command{.task = Task::make_solver, .degree = options.degree};
  exchange(ranks_, command);
  solver_.reset();
  all_or_nothing(ranks_,
                 [&] { solver_ = std::make_unique<PoissonSolver<3>>(&mesh, options, ranks_); });
}

SolutionRecord SolverTeam::solve(std::span<const Point<3>> coordinates,
                                 const std::vector<ManufacturedSolution<3>>& solutions,
                                 std::size_t number, bool is_result) {
  Command command{.task = Task::solve, .is_result = is_result, .solution = number};
  exchange(ranks_, command);
  return all_or_nothing(ranks_,
                        [&] { return solver_->solve(coordinates, solutions[number], is_result); });
}

std::vector<double> SolverTeam::nodal_errors() {
  Command command{.task = Task::nodal_errors};
  exchange(ranks_, command);
  return all_or_nothing(ranks_, [&] { return solver_->nodal_errors(); });
}

std::vector<double> SolverTeam::eigenvectors() {
  Command command{.task = Task::eigenvectors};
  exchange(ranks_, command);
  return all_or_nothing(ranks_, [&] { return solver_->eigenvectors(); });
}

void SolverTeam::set_eigenvectors(const std::vector<double>& eigenvectors) {
  Command command{.task = Task::set_eigenvectors};
  exchange(ranks_, command);
  all_or_nothing(ranks_, [&] { solver_->set_eigenvectors(eigenvectors); });
}

void SolverTeam::serve(const Ranks& ranks, const PoissonOptions& options,
                       const std::vector<ManufacturedSolution<3>>& solutions) {
  std::unique_ptr<PoissonSolver<3>> solver;
  const auto follow = [&](const Command& command) {
    switch (command.task) {
      case Task::make_solver: {
        PoissonOptions of_degree = options;
        of_degree.degree = command.degree;
        solver.reset();
        solver = std::make_unique<PoissonSolver<3>>(nullptr, of_degree, ranks);
        break;
      }
      case Task::solve:
        (void)solver->solve({}, solutions[command.solution], command.is_result != 0);
        break;
      case Task::nodal_errors:
        (void)solver->nodal_errors();
        break;
      case Task::eigenvectors:
        (void)solver->eigenvectors();
        break;
      case Task::set_eigenvectors:
        solver->set_eigenvectors({});
        break;
      case Task::stop:
        break;
    }
  };
  for (Command command{.task = Task::make_solver};;) {
    exchange(ranks, command);
    if (command.task == Task::stop) return;
    try {
      all_or_nothing(ranks, [&] { follow(command); });
    } catch (const InputError&) {
      // The root has thrown the same one, and says it.
    }
  }
}

}  // namespace smoothfem
