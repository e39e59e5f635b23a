// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "meshes/external/child_process.h"
#include "smoothing/loop/smoother.h"

namespace smoothfem {

/// A program of a user's study, with its files. Failures of the program are SmootherFailure.
struct ExternalProgram {
  std::string command;  ///< run by /bin/sh; relative programs lie in folders.given
  std::string files;    ///< to copy next to its input, separated by commas; also relative
  std::string version_command;
  double timeout = 3600.0;  ///< of a run, in seconds
  SmootherFolders folders{};

  /// Returns the path of the program. Throws SmootherFailure if there is none.
  std::filesystem::path path() const;

  /// Returns the program, its files and its version.
  SmootherOrigin origin();

  /// Copies the files to the folder of a run.
  void copy_files(const std::filesystem::path& folder) const;

  /// Returns a command with {NAME} replaced by values, and {folder} by folders.given.
  std::string filled_in(const std::string& given,
                        const std::map<std::string, std::string>& values) const;

  /// Runs a command in a folder, and adds its output to the log.
  CommandEnd run(const std::string& filled, const std::filesystem::path& folder);

  /// Runs a command; throws SmootherFailure unless it ends in time with exit code 0.
  CommandEnd run_to_success(const std::string& filled, const std::filesystem::path& folder);

  /// Returns the path of a file that the program has left. Throws SmootherFailure if there is none.
  std::filesystem::path left_file(const std::filesystem::path& folder,
                                  const std::string& name) const;

  /// Returns "; the last it printed: '...'" of the last run, or nothing.
  std::string last_output_text() const;

 private:
  std::vector<std::filesystem::path> given_files() const;
  std::filesystem::path in_study_folder(const std::filesystem::path& name) const;

  std::string last_output_;
};

/// True for regular files: reading a pipe or a device, which a program may leave, might not end.
bool is_plain_file(const std::filesystem::path& path);

}  // namespace smoothfem
