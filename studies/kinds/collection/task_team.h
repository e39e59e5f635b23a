// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <mpi.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fem/ranks/ranks.h"
#include "studies/kinds/collection/task_process.h"

namespace smoothfem {

/// Processes that share tasks: several of this machine, or one of each rank. A task is a line of
/// text, which goes to a TaskProcess with this process' command line.
class TaskTeam {
 public:
  /// n_processes: of this machine; counts if there is one rank. Of several ranks only the root has
  /// a team, the others serve it. Collective.
  TaskTeam(const Ranks& ranks, unsigned int n_processes);
  /// The other ranks end serving.
  ~TaskTeam();
  TaskTeam(const TaskTeam&) = delete;

  unsigned int size() const { return static_cast<unsigned int>(workers_.size()); }

  /// How many of the tasks are worked on at once.
  enum class AtOnce { all, one_on_each_machine };

  /// Does the tasks, in this order as far as there are processes for them. on_end: called with a
  /// task's number at its end. on_wait: called several times a second. Throws Interrupted when the
  /// user asks this process to end, and InputError if no process can be started.
  void run(const std::vector<std::string>& tasks, AtOnce at_once,
           const std::function<void(std::size_t, const TaskAnswer&)>& on_end,
           const std::function<void()>& on_wait);

 private:
  class Worker;
  class OwnWorker;
  class RankWorker;

  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<bool> is_first_of_machine_;  ///< of workers_
};

/// On ranks other than the root: does tasks until the root's team ends. Collective with its making.
void serve_task_team(const Ranks& ranks);

}  // namespace smoothfem
