// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/solve_workers.h"

#include <limits>
#include <mutex>
#include <optional>

#include "fem/materials/cell_kinds.h"
#include "meshes/refinement/split_cells.h"
#include "smoothing/base/scoped_timer.h"
#include "smoothing/base/text.h"
#include "smoothing/quality/mesh_quality.h"
#include "studies/framework/definition/study_file.h"

namespace smoothfem {

namespace {

template <int dim>
PoissonOptions options_of(const StudyData<dim>& data, const SolveJob& job) {
  PoissonOptions options = data.study.finite_elements;
  options.degree = data.solves[job.solve].degree;
  options.ties = data.meshes[job.mesh].ties;
  return options;
}

/// True if the record's nodal errors are kept. Results and series show them, refined meshes do not.
bool keeps_nodal_errors(const Study& study, const SolveTask& task) {
  return task.job.solve < study.degrees.size() && !task.job.is_refined && task.job.solution == 0 &&
         (task.is_result || study.write_series);
}

/// Returns the topology with its kinds of cells as their only groups. Refined cells have tags only,
/// but kinds may differ in further groups.
std::shared_ptr<const Topology> with_kinds_as_tags(std::shared_ptr<const Topology> topology) {
  const MeshLabels& given = topology->labels();
  if (!given.content || given.content->cell_entities.empty()) return topology;
  MeshLabels labels;
  labels.facets = given.facets;
  labels.facet_tags = given.facet_tags;
  labels.names = given.names;
  for (const auto kind : cell_kinds(*topology)) labels.cell_tags.push_back(static_cast<int>(kind));
  return std::make_shared<const Topology>(topology->dimension(), topology->n_nodes(),
                                          topology->cells(), topology->fixed_reasons(),
                                          std::move(labels));
}

/// Splits the cells of a task's mesh, and calls `solve` with the result. Splitting may make
/// hexahedra invalid; then `solve` is not called.
template <int dim, class Solve>
SolutionRecord solve_refined(const StudyData<dim>& data, const SolveTask& task,
                             const Solve& solve) {
  const Mesh<dim> refined = with_split_cells(
      Mesh<dim>(with_kinds_as_tags(data.meshes[task.job.mesh].mesh.shared_topology()),
                data.coordinates_of(task)));
  if (mesh_quality(refined).n_invalid == 0) return solve(refined);
  SolutionRecord record;
  record.status = invalid_mesh;
  return record;
}

/// Calls solve() for a record of this degree. A curved cell that is folded inside makes it that of
/// a failure.
template <class Solve>
SolutionRecord solve_unless_folded(int degree, const Solve& solve) {
  try {
    return solve();
  } catch (const CellError& folded) {
    SolutionRecord record;
    record.degree = degree;
    record.status = std::string("failed: ") + folded.what();
    return record;
  }
}

/// Returns the nodal errors of a record, which nodal_errors() returns if it has any.
template <class NodalErrors>
std::vector<double> errors_of(const SolutionRecord& record, std::size_t n_nodes,
                              const NodalErrors& nodal_errors) {
  if (record.status.starts_with("failed"))
    return std::vector<double>(n_nodes, std::numeric_limits<double>::quiet_NaN());
  return nodal_errors();
}

/// The solvers of one worker that are not Poisson's. Only the last one is kept.
template <int dim>
class OtherSolvers {
 public:
  /// team: see solver_on_mesh.
  explicit OtherSolvers(const StudyData<dim>& data, SolverTeam* team = nullptr)
      : data_(data), team_(team) {}

  /// Solves for a task of a solver.
  SolutionRecord solve(const SolveTask& task) {
    const SolveJob& job = task.job;
    const StudySolve& chosen = data_.solves[job.solve];
    SolutionRecord record;
    record.degree = chosen.degree;
    try {
      if (!solver_ || mesh_ != job.mesh || solve_ != job.solve) {
        solver_.reset();
        solver_ = solver_on_mesh(data_, job.mesh, chosen, team_);
        mesh_ = job.mesh;
        solve_ = job.solve;
      }
      SolverResult result =
          solver_->solve(data_.meshes[job.mesh].for_solvers(data_.coordinates_of(task)));
      record.numbers = std::move(result.numbers);
      record.status = std::move(result.status);
    } catch (const SolverFailure& failure) {
      record.status = std::string("failed: ") + failure.what();
    } catch (const InputError&) {
      throw;
    } catch (const std::exception& error) {  // from a plugin's libraries
      record.status = "failed: " + in_one_line(error.what());
    }
    return record;
  }

 private:
  const StudyData<dim>& data_;
  SolverTeam* team_;
  std::unique_ptr<MeshSolver<dim>> solver_;
  std::size_t mesh_ = 0, solve_ = 0;  ///< of the solver
};

/// Solvers for planar meshes and degrees, made at first use. Threads take copies, which share
/// everything that depends on the topology only.
class PlanarSolvers {
 public:
  explicit PlanarSolvers(const StudyData<2>& data) : data_(data) {}

  std::unique_ptr<PoissonSolver<2>> copy(const SolveJob& job) {
    const std::lock_guard guard(mutex_);
    auto& solver = solvers_[{job.mesh, job.solve}];
    if (!solver)
      solver =
          std::make_unique<PoissonSolver<2>>(&data_.meshes[job.mesh].mesh, options_of(data_, job));
    return std::make_unique<PoissonSolver<2>>(*solver);
  }

 private:
  const StudyData<2>& data_;
  std::mutex mutex_;
  std::map<std::pair<std::size_t, std::size_t>, std::unique_ptr<PoissonSolver<2>>> solvers_;
};

/// The work of one thread on planar meshes.
class PlanarWorker {
 public:
  PlanarWorker(StudyData<2>& data, std::shared_ptr<PlanarSolvers> solvers)
      : data_(data), solvers_(std::move(solvers)), others_(data) {}

  void work(SolveTask& task) {
    const SolveJob& job = task.job;
    double seconds = 0.0;
    SolutionRecord solution;
    {
      const ScopedTimer timer(seconds);
      solution =
          job.is_refined
              ? solve_refined(data_, task,
                              [&](const Mesh<2>& mesh) {
                                return PoissonSolver<2>(&mesh, options_of(data_, job))
                                    .solve(mesh.coordinates(), data_.solutions[job.mesh].front());
                              })
              : solve(task);
      if (keeps_nodal_errors(data_.study, task))
        data_.kept.save_numbers(job.name, task.record,
                                errors_of(solution, data_.meshes[job.mesh].mesh.n_nodes(),
                                          [&] { return solver_->nodal_errors(); }));
    }
    finish_task(task, std::move(solution), seconds, {}, data_.kept);
  }

 private:
  SolutionRecord solve(const SolveTask& task) {
    const SolveJob& job = task.job;
    if (data_.solves[job.solve].solver != nullptr) return others_.solve(task);
    if (!solver_ || mesh_ != job.mesh || solve_ != job.solve) {
      solver_ = solvers_->copy(job);
      mesh_ = job.mesh;
      solve_ = job.solve;
    }
    return solve_unless_folded(data_.solves[job.solve].degree, [&] {
      return solver_->solve(data_.coordinates_of(task), data_.solutions[job.mesh][job.solution],
                            task.is_result);
    });
  }

  StudyData<2>& data_;
  std::shared_ptr<PlanarSolvers> solvers_;
  std::unique_ptr<PoissonSolver<2>> solver_;
  std::size_t mesh_ = 0, solve_ = 0;  ///< of the solver
  OtherSolvers<2> others_;
};

/// The root's work on volume meshes. Eigenvectors are passed between the records of a job, but not
/// between jobs. So an interruption between jobs does not change results.
class TeamWorker {
 public:
  TeamWorker(StudyData<3>& data, SolverTeam& team)
      : data_(data), team_(team), others_(data, &team) {}

  void work(SolveTask& task) {
    const SolveJob& job = task.job;
    double seconds = 0.0;
    SolutionRecord solution;
    {
      const ScopedTimer timer(seconds);
      solution = job.is_refined
                     ? solve_refined(data_, task,
                                     [&](const Mesh<3>& mesh) {
                                       job_ = nullptr;  // the team has another solver now
                                       team_.make_solver(mesh, options_of(data_, job));
                                       return team_.solve(mesh.coordinates(),
                                                          data_.solutions[job.mesh], 0, true);
                                     })
                     : solve(task);
      if (keeps_nodal_errors(data_.study, task))
        data_.kept.save_numbers(job.name, task.record,
                                errors_of(solution, data_.meshes[job.mesh].mesh.n_nodes(),
                                          [&] { return team_.nodal_errors(); }));
    }
    const bool has_eigenvectors = !job.is_refined && data_.solves[job.solve].solver == nullptr;
    finish_task(task, std::move(solution), seconds,
                has_eigenvectors ? team_.eigenvectors() : std::vector<double>(), data_.kept);
  }

 private:
  SolutionRecord solve(const SolveTask& task) {
    const SolveJob& job = task.job;
    if (data_.solves[job.solve].solver != nullptr) return others_.solve(task);
    const bool other_solver = job_ == nullptr || job_->mesh != job.mesh || job_->solve != job.solve;
    if (other_solver) team_.make_solver(data_.meshes[job.mesh].mesh, options_of(data_, job));
    if (job_ != &job) team_.set_eigenvectors(job.solved.eigenvectors);
    job_ = &job;
    return solve_unless_folded(data_.solves[job.solve].degree, [&] {
      return team_.solve(data_.coordinates_of(task), data_.solutions[job.mesh], job.solution,
                         task.is_result);
    });
  }

  StudyData<3>& data_;
  SolverTeam& team_;
  const SolveJob* job_ = nullptr;  ///< the team's last one
  OtherSolvers<3> others_;
};

/// The work of each rank on meshes in parts. It does not keep eigenvectors or nodal errors.
template <int dim>
class PartsWorker {
 public:
  PartsWorker(StudyData<dim>& data, const Ranks& ranks) : data_(data), ranks_(ranks) {}

  void work(SolveTask& task) {
    const SolveJob& job = task.job;
    double seconds = 0.0;
    SolutionRecord solution;
    {
      const ScopedTimer timer(seconds);
      if (!solver_ || mesh_ != job.mesh) {
        solver_.emplace(&data_.meshes[job.mesh].mesh, options_of(data_, job), ranks_);
        mesh_ = job.mesh;
      }
      if (job_ != &job) solver_->set_eigenvectors({});
      job_ = &job;
      solution = solver_->solve(data_.coordinates_of(task), data_.solutions[job.mesh][job.solution],
                                task.is_result);
    }
    finish_task(task, std::move(solution), seconds, {}, data_.kept);
  }

 private:
  StudyData<dim>& data_;
  const Ranks& ranks_;
  std::optional<PoissonSolver<dim>> solver_;
  std::size_t mesh_ = 0;  ///< of the solver
  const SolveJob* job_ = nullptr;
};

}  // namespace

template <int dim>
SolveQueue::Worker solve_worker_in_parts(StudyData<dim>& data, const std::vector<SolveTask*>& tasks,
                                         const Ranks& ranks) {
  return [&tasks, worker = std::make_shared<PartsWorker<dim>>(data, ranks)](std::size_t task) {
    worker->work(*tasks[task]);
  };
}
template SolveQueue::Worker solve_worker_in_parts(StudyData<2>&, const std::vector<SolveTask*>&,
                                                  const Ranks&);
template SolveQueue::Worker solve_worker_in_parts(StudyData<3>&, const std::vector<SolveTask*>&,
                                                  const Ranks&);

template <int dim>
ManufacturedSolution<dim> study_solution(const StudySolution& solution,
                                         std::span<const Point<dim>> sample) {
  if (solution.name != "expression") return manufactured_solution<dim>(solution.name);
  return at_line(solution.lines, [&] {
    if (!solution.u.empty())
      return derived_solution<dim>(solution.u, solution.diffusivity, sample, solution.of_groups);
    return parsed_solution<dim>(solution.value, solution.gradient, solution.load, sample,
                                solution.diffusivity);
  });
}
template ManufacturedSolution<2> study_solution(const StudySolution&, std::span<const Point<2>>);
template ManufacturedSolution<3> study_solution(const StudySolution&, std::span<const Point<3>>);

template <int dim>
std::string u_text(const StudySolution& solution) {
  if (solution.name != "expression") return manufactured_solution<dim>(solution.name).formula;
  return solution.u.empty() ? solution.value : solution.u;
}
template std::string u_text<2>(const StudySolution&);
template std::string u_text<3>(const StudySolution&);

std::string diffusivity_text(const StudySolution& solution) {
  std::string text = solution.diffusivity;
  for (const auto& of_group : solution.of_groups)
    text += (text.empty() ? "" : "; ") + of_group.formula + " in group " + of_group.group;
  return text.empty() ? "1" : text;
}

template <int dim>
std::unique_ptr<MeshSolver<dim>> solver_on_mesh(const StudyData<dim>& data, std::size_t mesh,
                                                const StudySolve& solve, SolverTeam* team) {
  auto solver = solve.solver->template make<dim>();
  try {
    if (!solve.solver->traits.takes_curved_cells &&
        has_curved_cells(data.meshes[mesh].mesh.topology(), data.study.finite_elements.geometry))
      throw InputError(
          "it maps cells of second order by their corners alone; write 'set geometry = straight' "
          "in 'subsection finite elements', or leave it out of 'solvers'");
    if (solve.solver->traits.needs_solution) solver->use_solution(data.solutions[mesh].front());
    if (const auto& ties = data.meshes[mesh].ties) {
      if (!solve.solver->traits.takes_ties)
        throw InputError(
            "it has no constraints for hanging or periodic nodes; leave it out of 'solvers'");
      solver->use_ties(ties);
    } else if constexpr (dim == 3) {
      if (team != nullptr && team->n_ranks() > 1 && solve.solver->traits.takes_ranks)
        solver = team->shared(std::move(solver),
                              static_cast<std::size_t>(solve.solver - data.study.solvers.data()));
    }
    const auto& prepared = data.meshes[mesh];
    solver->initialize(prepared.for_solvers(prepared.mesh.copied_coordinates()), solve.degree);
  } catch (const SolverFailure&) {
    throw;
  } catch (const InputError& error) {
    throw InputError("mesh " + data.meshes[mesh].description.name + ", solver " +
                     solve.solver->label + ": " + error.what());
  }
  return solver;
}
template std::unique_ptr<MeshSolver<2>> solver_on_mesh(const StudyData<2>&, std::size_t,
                                                       const StudySolve&, SolverTeam*);
template std::unique_ptr<MeshSolver<3>> solver_on_mesh(const StudyData<3>&, std::size_t,
                                                       const StudySolve&, SolverTeam*);

bool needs_mpi(const Study& study) {
  for (const auto& solver : study.solvers)
    if (solver.traits.needs_mpi) return true;
  if (study.in_parts) return true;
  return !study.degrees.empty() &&
         (study.dimensions.cells == 3 || study.finite_elements.multigrid_cg != Recorded::never);
}

unsigned int n_solve_workers(const Study& study, const StudyOptions& options) {
  return study.dimensions.cells == 3 || needs_mpi(study) ? 1 : options.threads();
}

std::vector<SolveQueue::Worker> solve_workers(StudyData<2>& data,
                                              const std::vector<SolveTask*>& tasks,
                                              unsigned int n_workers) {
  const auto solvers = std::make_shared<PlanarSolvers>(data);
  std::vector<SolveQueue::Worker> workers;
  for (unsigned int i = 0; i < n_workers; ++i)
    workers.push_back([&tasks, worker = std::make_shared<PlanarWorker>(data, solvers)](
                          std::size_t task) { worker->work(*tasks[task]); });
  return workers;
}

std::vector<SolveQueue::Worker> solve_workers(StudyData<3>& data,
                                              const std::vector<SolveTask*>& tasks,
                                              SolverTeam& team) {
  return {[&tasks, worker = std::make_shared<TeamWorker>(data, team)](std::size_t task) {
    worker->work(*tasks[task]);
  }};
}

void serve_solves(const Study& study, const Ranks& ranks) {
  std::vector<ManufacturedSolution<3>> solutions;
  if (needs_solutions(study))
    for (const StudySolution* solution : solutions_of(study))
      solutions.push_back(study_solution<3>(*solution, {}));
  SolverTeam::serve(ranks, study.finite_elements, solutions, study.solvers);
}

}  // namespace smoothfem
