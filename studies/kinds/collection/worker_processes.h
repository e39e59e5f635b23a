// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

namespace smoothfem {

/// How a task of a worker has ended.
struct TaskEnd {
  std::size_t task;
  std::string outcome;  ///< what it returned
  std::string failure;  ///< what it threw, or what killed its process; empty: it is done
};

/// Runs tasks 0 to n_tasks - 1, in this order as far as there are processes for them, in copies of
/// this process (fork), so that one that crashes, or takes all memory, costs no other: its process
/// is replaced. A process takes several tasks, so that libraries are set up once in each. This
/// process must not have started threads.
///
/// start: called once in each worker process, returns what does a task there; that is destroyed
/// when no task is left. on_end: called here, at the end of each task. on_wait: called here several
/// times a second. Throws Interrupted when the user asks this process to end, after the end of all
/// workers, and InputError if no process can be started.
void run_in_workers(std::size_t n_tasks, unsigned int n_processes,
                    const std::function<std::function<std::string(std::size_t)>()>& start,
                    const std::function<void(const TaskEnd&)>& on_end,
                    const std::function<void()>& on_wait);

}  // namespace smoothfem
