// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/external/child_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <thread>

#include "smoothing/base/input_error.h"
#include "smoothing/base/interruption.h"
#include "smoothing/base/text.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Runs in the child, where only async-signal-safe calls are allowed after fork. Does not return.
[[noreturn]] void execute_command(const char* command, const char* folder, char* const* environment,
                                  int output) {
  setpgid(0, 0);                     // so that all processes it starts can be killed together
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // it ends with this process
  close_on_exec();
  const int nothing = open("/dev/null", O_RDONLY);
  if (chdir(folder) == 0 && dup2(nothing, 0) >= 0 && dup2(output, 1) >= 0 && dup2(output, 2) >= 0)
    execle("/bin/sh", "sh", "-c", command, static_cast<char*>(nullptr), environment);
  _exit(127);
}

/// Waits with growing pauses between checks, so that short runs are timed well.
int wait_for(pid_t child, double timeout_seconds, CommandEnd& end) {
  const auto start = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  auto pause = std::chrono::microseconds(50);
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    end.timed_out = seconds() > timeout_seconds;
    if (end.timed_out || interruption()) {
      kill(-child, SIGKILL);
      waitpid(child, &status, 0);
      break;
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(pause * 21 / 20, std::chrono::microseconds(5000));
  }
  end.wall_seconds = seconds();
  return status;
}

}  // namespace

std::vector<char*> environment_of_children() {
  std::vector<char*> entries;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    if (!text.starts_with("OMPI_") && !text.starts_with("PMIX_") && !text.starts_with("PMI_") &&
        !text.starts_with("ORTE_"))
      entries.push_back(*entry);
  }
  entries.push_back(nullptr);
  return entries;
}

void close_on_exec() {
  (void)close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);  // older kernels do nothing
}

CommandEnd run_command(const std::string& command, const fs::path& folder, double timeout_seconds) {
  const fs::path printed = folder / ".printed";
  const int output = open(printed.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const std::vector<char*> environment = environment_of_children();
  const pid_t child = output < 0 ? -1 : fork();
  if (child == 0) execute_command(command.c_str(), folder.c_str(), environment.data(), output);
  const int error = errno;
  if (output >= 0) close(output);
  if (child < 0)
    throw InputError("cannot start '" + command + "': " + std::strerror(error) +
                     "; close other programs, or free some space");
  setpgid(child, child);  // the child may not have done it yet
  CommandEnd end;
  const int status = wait_for(child, timeout_seconds, end);
  if (interruption()) throw Interrupted{};
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  constexpr int killed = 128;  // shells add this to the signal that killed a command
  if (end.exit_code > killed && end.exit_code < killed + NSIG) end.signal = end.exit_code - killed;
  end.output = file_content(printed);
  return end;
}

fs::path find_program(const std::string& name) {
  const auto is_program = [](const fs::path& path) {
    return fs::is_regular_file(path) && access(path.c_str(), X_OK) == 0;
  };
  if (name.find('/') != std::string::npos) return is_program(name) ? fs::path(name) : fs::path();
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/bin:/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const auto file = fs::path(folder.empty() ? "." : folder) / name; is_program(file))
      return file;
  return {};
}

std::string shell_quoted(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

ScratchFolder::ScratchFolder() {
  std::error_code error;
  std::string name = (fs::temp_directory_path(error) / "smoothfem-XXXXXX").string();
  if (error || mkdtemp(name.data()) == nullptr)
    throw InputError("cannot make a temporary folder " + name + ": " +
                     (error ? error.message() : std::strerror(errno)) +
                     "; name one that can be written to in TMPDIR");
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;  // leftovers are harmless
  fs::remove_all(path_, ignored);
}

}  // namespace smoothfem
