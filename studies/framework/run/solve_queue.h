// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace smoothfem {

/// Runs tasks on several threads, in their order. Each thread has its own worker. One thread alone
/// runs them one after the other.
class SolveQueue {
 public:
  using Worker = std::function<void(std::size_t task)>;

  SolveQueue(std::size_t n_tasks, std::vector<Worker> workers);
  /// Waits for running tasks, and starts no other.
  ~SolveQueue();
  SolveQueue(const SolveQueue&) = delete;

  std::size_t n_done() const { return n_done_; }
  bool finished() const { return n_done_ == n_tasks_ || failed_; }
  /// Throws the exception of a task, if one has thrown.
  void rethrow() const;

 private:
  void run_tasks(const Worker& worker);

  std::size_t n_tasks_;
  std::vector<Worker> workers_;
  std::atomic<std::size_t> next_{0}, n_done_{0};
  std::mutex mutex_;                 ///< guards writes to failure_
  std::exception_ptr failure_;       ///< the first one; written once, before failed_ is set
  std::atomic<bool> failed_{false};  ///< if true, failure_ may be read without the mutex
  std::vector<std::jthread> threads_;
};

}  // namespace smoothfem
