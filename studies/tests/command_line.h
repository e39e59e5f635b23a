// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "studies/tests/study_tests.h"

namespace smoothfem {

/// What a run of a program left.
struct Outcome {
  int exit_code = -1;  ///< -1: killed by a signal
  std::string out, err;
};

/// Tests that run the smoothfem executable, in a folder of their own.
class CommandLine : public FileTest {
 protected:
  static std::string quoted(const std::string& word) { return "'" + word + "'"; }

  /// Runs `smoothfem words...` in the test's folder.
  Outcome smoothfem(const std::vector<std::string>& words) const {
    std::string command = "cd " + quoted(file("").string()) + " && " + quoted(SMOOTHFEM_PROGRAM);
    for (const auto& word : words) command += " " + quoted(word);
    command += " > " + quoted(file(".out").string()) + " 2> " + quoted(file(".err").string());
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(file(".out")),
            content_of(file(".err"))};
  }
};

}  // namespace smoothfem
