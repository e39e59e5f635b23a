// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace smoothfem {

/// The result of a task.
struct TaskAnswer {
  std::string outcome;  ///< what it returned
  std::string failure;  ///< its exception, or what killed its process; empty: it is done
  /// True if the reason is not the task itself: a signal has killed its process, or another process
  /// works in the folder.
  bool may_succeed_later = false;
};

/// Another process of this program that does one task after the other. If a task crashes it or
/// takes all memory, only that task is lost: the next task has a new process.
/// Answers carry a mark and the number of their task, so that other text in the socket, or the
/// answer of a copy of the process, is not taken for an answer. Unlike a copy of this process, it
/// may be started while threads run and MPI is in use. It has its own MPI.
class TaskProcess {
 public:
  /// command: words that start the process. `--task-socket=NUMBER` is added to them, for
  /// answer_tasks. limit_seconds: a task that takes longer fails, and its process is ended; 0: no
  /// limit.
  explicit TaskProcess(std::vector<std::string> command, double limit_seconds = 0.0)
      : command_(std::move(command)), limit_seconds_(limit_seconds) {}
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
  /// How a process ended.
  struct End {
    std::string text;
    bool by_signal;
  };
  End reap();
  void end_if_unusable();
  TaskAnswer end_task(const std::string& reason);

  std::vector<std::string> command_;
  double limit_seconds_;
  pid_t process_ = -1;
  int socket_ = -1;
  bool is_busy_ = false;
  std::uint64_t task_ = 0;  ///< number of the last one
  std::chrono::steady_clock::time_point given_{};
  std::string unread_;
};

/// Returns the words that started this process.
std::vector<std::string> own_command();

/// Runs in a TaskProcess: does the tasks from this socket until it is closed. An exception of
/// `work` is an answer, too.
void answer_tasks(int socket, const std::function<std::string(const std::string&)>& work);

}  // namespace smoothfem
