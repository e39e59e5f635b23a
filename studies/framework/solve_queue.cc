// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/solve_queue.h"

namespace smoothfem {

SolveQueue::SolveQueue(std::size_t n_tasks, std::vector<Worker> workers)
    : n_tasks_(n_tasks), workers_(std::move(workers)) {
  for (const auto& worker : workers_) threads_.emplace_back([&] { work(worker); });
}

SolveQueue::~SolveQueue() {
  next_ = n_tasks_;
}

void SolveQueue::rethrow() const {
  if (failed_) std::rethrow_exception(failure_);
}

void SolveQueue::work(const Worker& worker) {
  for (std::size_t task = next_++; task < n_tasks_; task = next_++) {
    try {
      worker(task);
      ++n_done_;
    } catch (...) {
      if (!failed_.exchange(true)) failure_ = std::current_exception();
      next_ = n_tasks_;
      return;
    }
  }
}

}  // namespace smoothfem
