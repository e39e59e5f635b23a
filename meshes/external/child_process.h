// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace smoothfem {

/// How a command ended.
struct CommandEnd {
  int exit_code = 0;       ///< 127: it was not found
  int signal = 0;          ///< that killed it; 0: none
  bool timed_out = false;  ///< it ran too long, and was killed with all it had started
  double wall_seconds = 0.0;
  std::string output{};  ///< what it printed, standard error included
};

/// Runs a command by /bin/sh in a folder, without input, and waits for its end. At the end it does
/// not outlive this process. Throws Interrupted when the user asks this process to end (see
/// interruption.h), and InputError if no process can be started.
CommandEnd run_command(const std::string& command, const std::filesystem::path& folder,
                       double timeout_seconds);

/// This process' environment without what mpirun has told it: a program that uses MPI itself would
/// take itself for one of our ranks. Ends with a null pointer.
std::vector<char*> environment_of_children();

/// The file that /bin/sh starts for this name; empty if there is none.
std::filesystem::path find_program(const std::string& name);

/// A word that /bin/sh takes as it is.
std::string shell_quoted(const std::string& word);

/// A new empty folder for temporary files; gone with all that is in it when this is.
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
