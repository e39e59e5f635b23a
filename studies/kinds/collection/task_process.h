// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/types.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace smoothfem {

/// The result of a task.
struct TaskAnswer {
  std::string outcome;  ///< what it returned
  std::string failure;  ///< its exception, or what killed its process; empty: it is done
};

/// Another process of this program that does one task after the other. If a task crashes it or
/// takes all memory, only that task is lost: the next task has a new process.
/// Unlike a copy of this process, it may be started while threads run and MPI is in use. It has its
/// own MPI.
class TaskProcess {
 public:
  /// command: words that start the process. `--task-socket=NUMBER` is added to them, for
  /// answer_tasks.
  explicit TaskProcess(std::vector<std::string> command) : command_(std::move(command)) {}
  /// Ends the process, even in the middle of a task.
  ~TaskProcess();
  TaskProcess(const TaskProcess&) = delete;
  TaskProcess& operator=(const TaskProcess&) = delete;

  /// Gives a task: one line of text. The task before must have been answered. Throws InputError if
  /// no process can be started.
  void give(const std::string& task);
  /// Returns the answer to the task once, when the task has ended.
  std::optional<TaskAnswer> answer();

 private:
  void start();
  std::string reap();

  std::vector<std::string> command_;
  pid_t process_ = -1;
  int socket_ = -1;
  bool is_busy_ = false;
  std::string unread_;
};

/// Returns the words that started this process.
std::vector<std::string> own_command();

/// Runs in a TaskProcess: does the tasks from this socket until it is closed. An exception of
/// `work` is an answer, too.
void answer_tasks(int socket, const std::function<std::string(const std::string&)>& work);

}  // namespace smoothfem
