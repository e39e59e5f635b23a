#include "studies/framework/solve_queue.h"

#include <optional>

namespace smoothfem {

SolveQueue::SolveQueue(std::vector<PoissonSolver> solvers, const ManufacturedSolution& solution,
                       std::vector<SolveTask*> tasks, unsigned int n_threads)
    : solvers_(std::move(solvers)), solution_(solution), tasks_(std::move(tasks)) {
  for (unsigned int i = 0; i < n_threads; ++i) threads_.emplace_back([this] { work(); });
}

SolveQueue::~SolveQueue() {
  next_ = tasks_.size();
}

void SolveQueue::rethrow() const {
  if (failed_) std::rethrow_exception(failure_);
}

void SolveQueue::work() {
  std::vector<std::optional<PoissonSolver>> own(solvers_.size());
  for (std::size_t t = next_++; t < tasks_.size(); t = next_++) {
    try {
      SolveTask& task = *tasks_[t];
      auto& solver = own[task.solver];
      if (!solver) solver.emplace(solvers_[task.solver]);
      task.record = solver->solve(task.mesh, solution_);
      if (task.keep_nodal_errors) task.nodal_errors = solver->nodal_errors();
      task.done = true;
      ++n_done_;
    } catch (...) {
      if (!failed_.exchange(true)) failure_ = std::current_exception();
      next_ = tasks_.size();
      return;
    }
  }
}

}  // namespace smoothfem
