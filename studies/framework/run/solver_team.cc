// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/solver_team.h"

#include <chrono>
#include <cstdio>
#include <map>
#include <thread>

#include "smoothing/base/parallel.h"

namespace smoothfem {

namespace {

enum class Task : int {
  make_solver,
  solve,
  nodal_errors,
  eigenvectors,
  set_eigenvectors,
  make_energy_solver,
  solve_energy,
  energy_gradient,
  energy_function,
  end_energy_solver,
  stop
};

struct Command {
  Task task = Task::stop;
  int degree = 0;
  int is_result = 0;
  std::size_t solution = 0;
  std::size_t energy_solver = 0;
};

/// Waits with pauses, because waiting in MPI would keep a core busy that smoothing may need.
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

/// Runs the work that all ranks do alike. An InputError is the same on each rank and is thrown. Any
/// other exception is on one rank only, and the others would wait forever, so it ends all ranks.
template <class Work>
auto all_or_nothing(const Ranks& ranks, const Work& work) {
  try {
    return work();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    if (ranks.size() == 1) throw;
    std::fprintf(
        stderr,
        "smoothfem: process %d of %d failed (%s); the study resumes if you start it again\n",
        ranks.rank(), ranks.size(), error.what());
    MPI_Abort(ranks.communicator(), 1);
    throw;
  }
}

/// The root's part of a solver that all ranks share. It sends the other ranks their commands.
class TeamEnergySolver final : public EnergySolver<3> {
 public:
  TeamEnergySolver(const Ranks& ranks, std::size_t number, std::unique_ptr<EnergySolver<3>> part)
      : ranks_(ranks), number_(number), part_(std::move(part)) {}
  TeamEnergySolver(const TeamEnergySolver&) = delete;
  ~TeamEnergySolver() override { tell(Task::end_energy_solver); }

  double solve(std::span<const Point<3>> coordinates) override {
    tell(Task::solve_energy);
    return all_or_nothing(ranks_, [&] { return part_->solve(coordinates); });
  }
  std::vector<Point<3>> gradient() override {
    tell(Task::energy_gradient);
    return all_or_nothing(ranks_, [&] { return part_->gradient(); });
  }
  GatheredFunction<3> function() override {
    tell(Task::energy_function);
    return all_or_nothing(ranks_, [&] { return part_->function(); });
  }

 private:
  void tell(Task task) const {
    Command command{.task = task, .energy_solver = number_};
    exchange(ranks_, command);
  }

  const Ranks ranks_;
  const std::size_t number_;
  const std::unique_ptr<EnergySolver<3>> part_;
};

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

std::unique_ptr<EnergySolver<3>> SolverTeam::make_energy_solver(
    const Mesh<3>& mesh, const PoissonOptions& options,
    const std::vector<ManufacturedSolution<3>>& solutions, std::size_t number) {
  Command command{.task = Task::make_energy_solver,
                  .degree = options.degree,
                  .solution = number,
                  .energy_solver = n_energy_solvers_};
  exchange(ranks_, command);
  auto part = all_or_nothing(ranks_, [&] {
    return smoothfem::make_energy_solver(&mesh, options.degree, solutions[number],
                                         options.natural_groups, ranks_);
  });
  return std::make_unique<TeamEnergySolver>(ranks_, n_energy_solvers_++, std::move(part));
}

void SolverTeam::serve(const Ranks& ranks, const PoissonOptions& options,
                       const std::vector<ManufacturedSolution<3>>& solutions) {
  set_n_threads(1);  // there is one rank for each core
  std::unique_ptr<PoissonSolver<3>> solver;
  std::map<std::size_t, std::unique_ptr<EnergySolver<3>>> energy_solvers;
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
      case Task::make_energy_solver:
        energy_solvers[command.energy_solver] = smoothfem::make_energy_solver<3>(
            nullptr, command.degree, solutions[command.solution], options.natural_groups, ranks);
        break;
      case Task::solve_energy:
        (void)energy_solvers.at(command.energy_solver)->solve({});
        break;
      case Task::energy_gradient:
        (void)energy_solvers.at(command.energy_solver)->gradient();
        break;
      case Task::energy_function:
        (void)energy_solvers.at(command.energy_solver)->function();
        break;
      case Task::end_energy_solver:
        energy_solvers.erase(command.energy_solver);
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
      // The root has thrown the same error, and reports it.
    }
  }
}

}  // namespace smoothfem
