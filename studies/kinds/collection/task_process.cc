// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/collection/task_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>
#include <sstream>

#include "meshes/external/child_process.h"
#include "smoothing/base/input_error.h"
#include "smoothing/base/text.h"

namespace smoothfem {

namespace {

constexpr char done = 'd', failed = 'f';

/// Sends a line. Returns false if the other end is closed.
bool send_line(int socket, std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  text += '\n';
  for (std::size_t n_sent = 0; n_sent < text.size();) {
    const auto n = ::send(socket, text.data() + n_sent, text.size() - n_sent, MSG_NOSIGNAL);
    if (n < 0 && errno != EINTR) return false;
    if (n > 0) n_sent += static_cast<std::size_t>(n);
  }
  return true;
}

/// Waits for text and appends it. Returns false at the end of the stream.
bool receive(int socket, std::string& unread) {
  char buffer[4096];
  const auto n = ::recv(socket, buffer, sizeof(buffer), 0);
  if (n > 0) unread.append(buffer, static_cast<std::size_t>(n));
  return n > 0 || (n < 0 && errno == EINTR);
}

std::optional<std::string> take_line(std::string& unread) {
  const auto end = unread.find('\n');
  if (end == std::string::npos) return std::nullopt;
  std::string line = unread.substr(0, end);
  unread.erase(0, end + 1);
  return line;
}

/// Returns a letter (done or failed), followed by the result or the reason.
std::string answer_to(const std::string& task,
                      const std::function<std::string(const std::string&)>& work) {
  try {
    return done + work(task);
  } catch (const std::bad_alloc&) {
    return failed + std::string("there is not enough memory for it");
  } catch (const std::exception& error) {
    return failed + std::string(error.what());
  }
}

[[noreturn]] void refuse() {
  throw InputError(std::string("cannot start a process: ") + std::strerror(errno) +
                   "; close other programs, or take fewer --threads");
}

}  // namespace

TaskProcess::~TaskProcess() {
  if (process_ < 0) return;
  if (is_busy_) ::kill(process_, SIGKILL);
  reap();
}

void TaskProcess::start() {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) refuse();
  std::vector<std::string> words = command_;
  words.push_back("--task-socket=" + std::to_string(ends[1]));
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const std::vector<char*> environment = environment_of_children();
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ == 0) {                      // only system calls are safe here
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);     // it ends with its parent
    if (::getppid() != parent) ::_exit(1);  // the parent has already ended
    ::fcntl(ends[1], F_SETFD, 0);
    ::execve("/proc/self/exe", arguments.data(), environment.data());
    ::_exit(127);
  }
  const int error = errno;
  ::close(ends[1]);
  socket_ = ends[0];
  if (process_ > 0) return;
  ::close(socket_);
  errno = error;
  refuse();
}

void TaskProcess::give(const std::string& task) {
  if (process_ < 0) start();
  is_busy_ = true;
  send_line(socket_, task);  // if the process is dead, answer() reports it
}

std::optional<TaskAnswer> TaskProcess::answer() {
  if (!is_busy_) return std::nullopt;
  pollfd polled{socket_, POLLIN, 0};
  while (::poll(&polled, 1, 0) > 0) {
    const bool is_alive = receive(socket_, unread_);
    const auto line = take_line(unread_);
    if (is_alive && !line) continue;
    is_busy_ = false;
    if (!line) return TaskAnswer{"", "the process that worked on it " + reap()};
    return (*line)[0] == done ? TaskAnswer{line->substr(1), ""} : TaskAnswer{"", line->substr(1)};
  }
  return std::nullopt;
}

/// Waits for the process to end, and returns how it ended.
std::string TaskProcess::reap() {
  ::close(socket_);  // the process ends when it sees that
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
  process_ = -1;
  unread_.clear();
  return WIFSIGNALED(status) ? std::string("was killed: ") + ::strsignal(WTERMSIG(status))
                             : "has ended with exit code " + std::to_string(WEXITSTATUS(status));
}

std::vector<std::string> own_command() {
  std::vector<std::string> words;
  std::istringstream line(file_content("/proc/self/cmdline"));
  for (std::string word; std::getline(line, word, '\0');) words.push_back(word);
  return words;
}

void answer_tasks(int socket, const std::function<std::string(const std::string&)>& work) {
  std::signal(SIGINT, SIG_IGN);  // the process that gives the tasks decides
  std::signal(SIGTERM, SIG_DFL);
  std::string unread;
  do
    while (const auto task = take_line(unread)) send_line(socket, answer_to(*task, work));
  while (receive(socket, unread));
}

}  // namespace smoothfem
