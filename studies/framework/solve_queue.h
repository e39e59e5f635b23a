#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "fem/poisson_solver.h"

namespace smoothfem {

/// A finite element record to be made: which solver, which mesh, and where the numbers go.
struct SolveTask {
  std::size_t solver;  ///< index of the solver for this topology and degree
  PlanarMesh mesh;
  bool keep_nodal_errors = false;

  SolutionRecord record;
  std::vector<double> nodal_errors;
  std::atomic<bool> done{false};  ///< set last: then everything else may be read by other threads

  SolveTask(std::size_t which, PlanarMesh where, bool keep)
      : solver(which), mesh(std::move(where)), keep_nodal_errors(keep) {}
};

/// Works off tasks on several threads, each with its own copies of the solvers: records do not
/// depend on each other, so neither on the threads.
class SolveQueue {
 public:
  SolveQueue(std::vector<PoissonSolver> solvers, const ManufacturedSolution& solution,
             std::vector<SolveTask*> tasks, unsigned int n_threads);
  /// Lets tasks under way finish, starts no other.
  ~SolveQueue();
  SolveQueue(const SolveQueue&) = delete;

  std::size_t n_done() const { return n_done_; }
  bool finished() const { return n_done_ == tasks_.size() || failed_; }
  /// Throws what a task has thrown, if one has.
  void rethrow() const;

 private:
  void work();

  std::vector<PoissonSolver> solvers_;
  const ManufacturedSolution& solution_;
  std::vector<SolveTask*> tasks_;
  std::atomic<std::size_t> next_{0}, n_done_{0};
  std::atomic<bool> failed_{false};
  std::exception_ptr failure_;
  std::vector<std::jthread> threads_;
};

}  // namespace smoothfem
