// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <mpi.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fem/ranks/ranks.h"
#include "studies/kinds/collection/tasks/task_process.h"

namespace smoothfem {

/// Processes that share tasks: several on this machine, or one of each rank. A task is a line of
/// text for a TaskProcess, which has this process' command line.
class TaskTeam {
 public:
  /// n_processes: number on this machine, used if there is one rank. With several ranks only the
  /// root has a team, and the others serve it. limit_seconds: of each task, as for TaskProcess.
  /// Collective.
  TaskTeam(const Ranks& ranks, unsigned int n_processes, double limit_seconds);
  /// Ends the serving of the other ranks.
  ~TaskTeam();
  TaskTeam(const TaskTeam&) = delete;

  unsigned int size() const { return static_cast<unsigned int>(workers_.size()); }

  /// The number of tasks that run at once.
  enum class AtOnce { all, one_on_each_machine };

  /// Does the tasks, and starts them in this order. on_end: called with a task's number at its end.
  /// on_wait: called several times a second. Throws Interrupted when the user asks this process to
  /// end, and InputError if no process can be started.
  void run(const std::vector<std::string>& tasks, AtOnce at_once,
           const std::function<void(std::size_t, const TaskAnswer&)>& on_end,
           const std::function<void()>& on_wait);

 private:
  class Worker;
  class OwnWorker;
  class RankWorker;

  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<bool> is_first_of_machine_;  ///< for each of workers_
};

/// Does tasks, on ranks other than the root, until the root's team ends. Collective with the making
/// of the team.
void serve_task_team(const Ranks& ranks, double limit_seconds);

}  // namespace smoothfem
