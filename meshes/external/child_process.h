// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace smoothfem {

/// End and output of a command.
struct CommandEnd {
  int exit_code = 0;  ///< 127: the command was not found
  int signal = 0;     ///< signal that killed it; 0: none
  /// True if it ran too long and was killed with all processes it had started.
  bool timed_out = false;
  double wall_seconds = 0.0;
  std::string output{};  ///< its output, including standard error
};

/// Runs a command by /bin/sh in a folder, without input, and waits for its end. The command ends
/// with this process at the latest. Throws Interrupted when the user asks this process to end
/// (interruption.h), and InputError if no process can be started.
CommandEnd run_command(const std::string& command, const std::filesystem::path& folder,
                       double timeout_seconds);

/// Returns this process' environment without the variables of mpirun: a program that uses MPI would
/// take itself for one of this program's ranks. Ends with a null pointer.
std::vector<char*> environment_of_children();

/// Closes all files of this process but standard input, output and error when it starts a program,
/// for example those of mpirun. May be called between fork and exec.
void close_on_exec();

/// Returns the file that /bin/sh starts for this name; empty if there is no such file.
std::filesystem::path find_program(const std::string& name);

/// Returns a word quoted so that /bin/sh keeps it unchanged.
std::string shell_quoted(const std::string& word);

/// A new, empty temporary folder; removed with its content at the end of its lifetime.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace smoothfem
