// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/solve_queue.h"

namespace smoothfem {

SolveQueue::SolveQueue(std::size_t n_tasks, std::vector<Worker> workers)
    : n_tasks_(n_tasks), workers_(std::move(workers)) {
  for (const auto& worker : workers_) threads_.emplace_back([&] { run_tasks(worker); });
}

SolveQueue::~SolveQueue() {
  next_ = n_tasks_;
}

void SolveQueue::rethrow() const {
  if (failed_) std::rethrow_exception(failure_);
}

void SolveQueue::run_tasks(const Worker& worker) {
  for (std::size_t task = next_++; task < n_tasks_; task = next_++) {
    try {
      worker(task);
      ++n_done_;
    } catch (...) {
      {
        const std::lock_guard guard(mutex_);
        if (!failure_) failure_ = std::current_exception();
      }
      failed_ = true;
      next_ = n_tasks_;
      return;
    }
  }
}

}  // namespace smoothfem
