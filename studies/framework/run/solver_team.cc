// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/solver_team.h"

#include <chrono>
#include <map>
#include <thread>

#include "smoothing/base/parallel.h"
#include "studies/framework/run/all_or_nothing.h"

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
  make_mesh_solver,
  solve_mesh,
  end_mesh_solver,
  stop
};

struct Command {
  Task task = Task::stop;
  int degree = 0;
  int is_result = 0;
  std::size_t solution = 0;
  std::size_t number = 0;  ///< of an energy solver or another solver
  std::size_t type = 0;    ///< of the other solver: its number in the study
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
    Command command{.task = task, .number = number_};
    exchange(ranks_, command);
  }

  const Ranks ranks_;
  const std::size_t number_;
  const std::unique_ptr<EnergySolver<3>> part_;
};

/// The root's part of a solver of another type, in the same way.
class TeamMeshSolver final : public MeshSolver<3> {
 public:
  TeamMeshSolver(const Ranks& ranks, std::size_t number, std::size_t type,
                 std::unique_ptr<MeshSolver<3>> part)
      : ranks_(ranks), number_(number), type_(type), part_(std::move(part)) {
    part_->use_ranks(ranks_);
  }
  TeamMeshSolver(const TeamMeshSolver&) = delete;
  ~TeamMeshSolver() override { tell({.task = Task::end_mesh_solver}); }

  void initialize(const Mesh<3>& mesh, int degree) override {
    tell({.task = Task::make_mesh_solver, .degree = degree});
    all_or_nothing(ranks_, [&] { part_->initialize(mesh, degree); });
  }
  SolverResult solve(const Mesh<3>& mesh) override {
    tell({.task = Task::solve_mesh});
    return all_or_nothing(ranks_, [&] { return part_->solve(mesh); });
  }

 private:
  void tell(Command command) const {
    command.number = number_;
    command.type = type_;
    exchange(ranks_, command);
  }

  const Ranks ranks_;
  const std::size_t number_, type_;
  const std::unique_ptr<MeshSolver<3>> part_;
};

/// A mesh for ranks other than the root, whose solvers do not look at it.
Mesh<3> mesh_of_others() {
  CompressedRows<NodeIndex> cells;
  cells.append(std::vector<NodeIndex>{0, 1, 2, 3});
  return {std::make_shared<const Topology>(3, 4, std::move(cells)),
          {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
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

std::unique_ptr<EnergySolver<3>> SolverTeam::make_energy_solver(
    const Mesh<3>& mesh, const PoissonOptions& options,
    const std::vector<ManufacturedSolution<3>>& solutions, std::size_t number) {
  Command command{.task = Task::make_energy_solver,
                  .degree = options.degree,
                  .solution = number,
                  .number = n_solvers_};
  exchange(ranks_, command);
  auto part = all_or_nothing(ranks_, [&] {
    return smoothfem::make_energy_solver(&mesh, options.degree, solutions[number],
                                         options.natural_groups, ranks_);
  });
  return std::make_unique<TeamEnergySolver>(ranks_, n_solvers_++, std::move(part));
}

std::unique_ptr<MeshSolver<3>> SolverTeam::shared(std::unique_ptr<MeshSolver<3>> part,
                                                  std::size_t solver) {
  return std::make_unique<TeamMeshSolver>(ranks_, n_solvers_++, solver, std::move(part));
}

void SolverTeam::serve(const Ranks& ranks, const PoissonOptions& options,
                       const std::vector<ManufacturedSolution<3>>& solutions,
                       const std::vector<StudySolver>& solvers) {
  set_n_threads(1);  // there is one rank for each core
  std::unique_ptr<PoissonSolver<3>> solver;
  std::map<std::size_t, std::unique_ptr<EnergySolver<3>>> energy_solvers;
  std::map<std::size_t, std::unique_ptr<MeshSolver<3>>> mesh_solvers;
  const Mesh<3> no_mesh = mesh_of_others();
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
        energy_solvers[command.number] = smoothfem::make_energy_solver<3>(
            nullptr, command.degree, solutions[command.solution], options.natural_groups, ranks);
        break;
      case Task::solve_energy:
        (void)energy_solvers.at(command.number)->solve({});
        break;
      case Task::energy_gradient:
        (void)energy_solvers.at(command.number)->gradient();
        break;
      case Task::energy_function:
        (void)energy_solvers.at(command.number)->function();
        break;
      case Task::end_energy_solver:
        energy_solvers.erase(command.number);
        break;
      case Task::make_mesh_solver: {
        const StudySolver& of_study = solvers[command.type];
        auto& made = mesh_solvers[command.number] = of_study.make<3>();
        if (of_study.traits.needs_solution) made->use_solution(solutions.front());
        made->use_ranks(ranks);
        made->initialize(no_mesh, command.degree);
        break;
      }
      case Task::solve_mesh:
        (void)mesh_solvers.at(command.number)->solve(no_mesh);
        break;
      case Task::end_mesh_solver:
        mesh_solvers.erase(command.number);
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
