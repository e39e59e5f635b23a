// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/collection/worker_processes.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <list>
#include <new>
#include <optional>
#include <vector>

#include "smoothing/base/input_error.h"
#include "smoothing/base/interruption.h"

namespace smoothfem {

namespace {

using Start = std::function<std::function<std::string(std::size_t)>()>;

/// The next task, in memory that this process and its workers share.
class NextTask {
 public:
  NextTask() {
    void* memory = ::mmap(nullptr, sizeof(std::atomic<std::size_t>), PROT_READ | PROT_WRITE,
                          MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    next_ = new (memory) std::atomic<std::size_t>(0);
  }
  ~NextTask() { ::munmap(next_, sizeof(*next_)); }
  NextTask(const NextTask&) = delete;

  std::size_t take() { return (*next_)++; }
  std::size_t next() const { return *next_; }

 private:
  std::atomic<std::size_t>* next_;
};

/// A message is a line: a letter, the task, and a text.
enum Message : char { begun = 'b', done = 'd', failed = 'f' };

void tell(int pipe, Message message, std::size_t task, std::string text = {}) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  const std::string line = std::string(1, message) + std::to_string(task) + " " + text + "\n";
  for (std::size_t n_written = 0; n_written < line.size();) {
    const auto n = ::write(pipe, line.data() + n_written, line.size() - n_written);
    if (n < 0 && errno != EINTR) ::_exit(1);  // nobody listens any more
    if (n > 0) n_written += static_cast<std::size_t>(n);
  }
}

[[noreturn]] void work(int pipe, std::size_t n_tasks, NextTask& next, const Start& start) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // it ends with the process that gives the tasks
  std::signal(SIGINT, SIG_IGN);        // that process decides
  std::signal(SIGTERM, SIG_DFL);
  {
    std::function<std::string(std::size_t)> task_function;
    for (std::size_t task = next.take(); task < n_tasks; task = next.take()) {
      tell(pipe, begun, task);
      try {
        if (!task_function) task_function = start();
        tell(pipe, done, task, task_function(task));
      } catch (const std::bad_alloc&) {
        tell(pipe, failed, task, "there is not enough memory for it");
      } catch (const std::exception& error) {
        tell(pipe, failed, task, error.what());
      }
    }
  }
  std::fflush(nullptr);
  ::_exit(0);
}

struct Worker {
  pid_t process;
  int pipe;
  std::string unread{};
  std::optional<std::size_t> task{};  ///< that it has begun
};

class Workers {
 public:
  Workers(std::size_t n_tasks, const Start& start,
          const std::function<void(const TaskEnd&)>& on_end)
      : n_tasks_(n_tasks), start_(start), on_end_(on_end) {}
  ~Workers() {
    for (const auto& worker : workers_) {
      ::kill(worker.process, SIGKILL);
      ::waitpid(worker.process, nullptr, 0);
      ::close(worker.pipe);
    }
  }
  Workers(const Workers&) = delete;

  /// Until there are so many, or no task is left for another one.
  void start_until(unsigned int n_processes) {
    while (workers_.size() < n_processes && next_.next() < n_tasks_) start_one();
  }

  bool empty() const { return workers_.empty(); }

  /// Hears what workers say for some time, and buries those that are dead.
  void listen() {
    std::vector<pollfd> polled;
    for (const auto& worker : workers_) polled.push_back({worker.pipe, POLLIN, 0});
    constexpr int milliseconds = 100;
    if (::poll(polled.data(), polled.size(), milliseconds) <= 0) return;
    auto worker = workers_.begin();
    for (const auto& p : polled)
      worker = p.revents == 0 || hear(*worker) ? std::next(worker) : workers_.erase(worker);
  }

 private:
  void start_one() {
    int ends[2];
    std::fflush(nullptr);  // what waits to be printed is printed once
    if (::pipe2(ends, O_CLOEXEC) != 0) refuse();
    const pid_t process = ::fork();
    if (process < 0) refuse();
    if (process == 0) {
      ::close(ends[0]);
      work(ends[1], n_tasks_, next_, start_);
    }
    ::close(ends[1]);
    workers_.push_back({process, ends[0]});
  }

  [[noreturn]] static void refuse() {
    throw InputError(std::string("cannot start a process: ") + std::strerror(errno) +
                     "; close other programs, or take fewer --threads");
  }

  /// Whether it lives.
  bool hear(Worker& worker) {
    char buffer[4096];
    const auto n = ::read(worker.pipe, buffer, sizeof(buffer));
    if (n < 0 && errno == EINTR) return true;
    if (n > 0) {
      worker.unread.append(buffer, static_cast<std::size_t>(n));
      for (auto end = worker.unread.find('\n'); end != std::string::npos;
           end = worker.unread.find('\n')) {
        take_message(worker, worker.unread.substr(0, end));
        worker.unread.erase(0, end + 1);
      }
      return true;
    }
    bury(worker);
    return false;
  }

  void take_message(Worker& worker, const std::string& line) {
    const auto blank = line.find(' ');
    const std::size_t task = std::stoul(line.substr(1, blank - 1));
    const std::string text = line.substr(blank + 1);
    if (line[0] == begun) {
      worker.task = task;
      return;
    }
    worker.task.reset();
    on_end_({task, line[0] == done ? text : "", line[0] == failed ? text : ""});
  }

  void bury(const Worker& worker) {
    int status = 0;
    ::waitpid(worker.process, &status, 0);
    ::close(worker.pipe);
    if (!worker.task) return;
    const std::string why = WIFSIGNALED(status)
                                ? std::string("was killed: ") + ::strsignal(WTERMSIG(status))
                                : "has ended with exit code " + std::to_string(WEXITSTATUS(status));
    on_end_({*worker.task, "", "the process that worked on it " + why});
  }

  std::size_t n_tasks_;
  const Start& start_;
  const std::function<void(const TaskEnd&)>& on_end_;
  NextTask next_;
  std::list<Worker> workers_;
};

}  // namespace

void run_in_workers(std::size_t n_tasks, unsigned int n_processes, const Start& start,
                    const std::function<void(const TaskEnd&)>& on_end,
                    const std::function<void()>& on_wait) {
  Workers workers(n_tasks, start, on_end);
  for (workers.start_until(n_processes); !workers.empty(); workers.start_until(n_processes)) {
    workers.listen();
    on_wait();
    if (interruption()) throw Interrupted{};
  }
}

}  // namespace smoothfem
