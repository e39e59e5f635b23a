// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/types.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace smoothfem {

/// What a task has come to.
struct TaskAnswer {
  std::string outcome;  ///< what it returned
  std::string failure;  ///< what it threw, or what killed its process; empty: it is done
};

/// Another process of this program that does one task after the other, so that one that crashes, or
/// takes all memory, costs no other: the next one has a new process. Unlike a copy of this process
/// it may be started where threads run and MPI is in use, and has an MPI of its own.
class TaskProcess {
 public:
  /// command: the words it is started with, to which `--task-socket=NUMBER` is added, for
  /// answer_tasks.
  explicit TaskProcess(std::vector<std::string> command) : command_(std::move(command)) {}
  /// It ends, in the middle of a task if there is one.
  ~TaskProcess();
  TaskProcess(const TaskProcess&) = delete;
  TaskProcess& operator=(const TaskProcess&) = delete;

  /// A task is one line of text, given when the one before is answered. Throws InputError if no
  /// process can be started.
  void give(const std::string& task);
  /// To the task, once, when it has ended.
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

/// The words that this process has been started with.
std::vector<std::string> own_command();

/// In a TaskProcess: does the tasks that come from this socket until it is closed. What `work`
/// throws is an answer, too.
void answer_tasks(int socket, const std::function<std::string(const std::string&)>& work);

}  // namespace smoothfem
