// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/collection/tasks/task_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>
#include <sstream>

#include "meshes/external/child_process.h"
#include "smoothing/base/input_error.h"
#include "smoothing/base/text.h"
#include "studies/framework/results/folder_lock.h"

namespace smoothfem {

namespace {

enum class Kind : std::uint64_t { task, done, failed, failed_for_now };

/// A message between the two processes: this and the text.
struct Head {
  std::array<char, 8> mark{'s', 'm', 'f', 'e', 'm', '\x01', '\xfe', '\n'};
  std::uint64_t task = 0;
  Kind kind = Kind::task;
  std::uint64_t length = 0;  ///< of the text
};

struct Message {
  std::uint64_t task;
  Kind kind;
  std::string text;
};

/// Sends a message. Returns false if the other end is closed.
bool send_message(int socket, const Message& message) {
  const Head head{.task = message.task, .kind = message.kind, .length = message.text.size()};
  std::string bytes(sizeof(head), '\0');
  std::memcpy(bytes.data(), &head, sizeof(head));
  bytes += message.text;
  for (std::size_t n_sent = 0; n_sent < bytes.size();) {
    const auto n = ::send(socket, bytes.data() + n_sent, bytes.size() - n_sent, MSG_NOSIGNAL);
    if (n < 0 && errno != EINTR) return false;
    if (n > 0) n_sent += static_cast<std::size_t>(n);
  }
  return true;
}

/// Waits for bytes and appends them. Returns false at the end of the stream.
bool receive(int socket, std::string& unread) {
  char buffer[4096];
  const auto n = ::recv(socket, buffer, sizeof(buffer), 0);
  if (n > 0) unread.append(buffer, static_cast<std::size_t>(n));
  return n > 0 || (n < 0 && errno == EINTR);
}

/// True if the bytes cannot be the beginning of a message.
bool is_garbage(const std::string& unread) {
  constexpr std::uint64_t longest = 1 << 26;
  Head head;
  const auto n = std::min(unread.size(), head.mark.size());
  if (std::memcmp(unread.data(), head.mark.data(), n) != 0) return true;
  if (unread.size() < sizeof(head)) return false;
  std::memcpy(&head, unread.data(), sizeof(head));
  return head.length > longest || head.kind > Kind::failed_for_now;
}

std::optional<Message> take_message(std::string& unread) {
  Head head;
  if (unread.size() < sizeof(head) || is_garbage(unread)) return std::nullopt;
  std::memcpy(&head, unread.data(), sizeof(head));
  if (unread.size() - sizeof(head) < head.length) return std::nullopt;
  Message message{head.task, head.kind, unread.substr(sizeof(head), head.length)};
  unread.erase(0, sizeof(head) + head.length);
  return message;
}

Message answer_to(const Message& task, const std::function<std::string(const std::string&)>& work) {
  const auto answer = [&](Kind kind, std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return Message{task.task, kind, std::move(text)};
  };
  try {
    return answer(Kind::done, work(task.text));
  } catch (const std::bad_alloc&) {
    return answer(Kind::failed, "there is not enough memory for it");
  } catch (const FolderTaken& taken) {
    return answer(Kind::failed_for_now, taken.what());
  } catch (const std::exception& error) {
    return answer(Kind::failed, error.what());
  }
}

bool has_ended(pid_t process) {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == process;
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
    close_on_exec();
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

/// Ends the process if it has died since its last answer, or has written anything else.
void TaskProcess::end_if_unusable() {
  pollfd polled{socket_, POLLIN, 0};
  while (process_ >= 0 && ::poll(&polled, 1, 0) > 0) {
    const bool is_alive = receive(socket_, unread_);
    while (take_message(unread_)) continue;
    if (!is_alive || is_garbage(unread_)) end_task("");
  }
}

void TaskProcess::give(const std::string& task) {
  end_if_unusable();
  if (process_ < 0) start();
  is_busy_ = true;
  given_ = std::chrono::steady_clock::now();
  // If the process is dead, answer() reports it.
  send_message(socket_, {++task_, Kind::task, task});
}

std::optional<TaskAnswer> TaskProcess::answer() {
  if (!is_busy_) return std::nullopt;
  bool is_alive = !has_ended(process_);  // a copy of it may keep the socket open
  pollfd polled{socket_, POLLIN, 0};
  while (::poll(&polled, 1, 0) > 0) {
    const bool is_open = receive(socket_, unread_);
    while (const auto message = take_message(unread_)) {
      if (message->task != task_) continue;  // of an earlier task, by a copy of the process
      is_busy_ = false;
      if (message->kind == Kind::done) return TaskAnswer{message->text, ""};
      return TaskAnswer{"", message->text, message->kind == Kind::failed_for_now};
    }
    if (is_garbage(unread_))
      return end_task(
          "its method has written into a file descriptor that is not its own, the one of its "
          "answers");
    is_alive = is_alive && is_open;
    if (!is_open) break;
  }
  if (!is_alive) {
    is_busy_ = false;
    const End end = reap();
    return TaskAnswer{"", "the process that worked on it " + end.text, end.by_signal};
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - given_;
  if (limit_seconds_ > 0.0 && taken.count() > limit_seconds_)
    return end_task("it has taken longer than the time limit of " + number_text(limit_seconds_) +
                    " s");
  return std::nullopt;
}

/// Ends the process in the middle of a task.
TaskAnswer TaskProcess::end_task(const std::string& reason) {
  ::kill(process_, SIGKILL);
  is_busy_ = false;
  reap();
  return {"", reason};
}

/// Waits for the process to end.
TaskProcess::End TaskProcess::reap() {
  ::close(socket_);  // the process ends when it sees that
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
  process_ = -1;
  unread_.clear();
  if (WIFSIGNALED(status))
    return {std::string("was killed: ") + ::strsignal(WTERMSIG(status)), true};
  return {"has ended with exit code " + std::to_string(WEXITSTATUS(status)), false};
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
  const pid_t own = ::getpid();
  std::string unread;
  do {
    while (const auto task = take_message(unread)) {
      const Message answer = answer_to(*task, work);
      if (::getpid() != own) ::_exit(0);  // a copy that the task has made of this process
      send_message(socket, answer);
    }
  } while (receive(socket, unread));
}

}  // namespace smoothfem
