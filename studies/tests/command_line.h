// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "studies/tests/study_tests.h"

namespace smoothfem {

/// The result of running a program.
struct Outcome {
  int exit_code = -1;  ///< -1: killed by a signal
  std::string out, err;
};

/// Tests that run the smoothfem executable, in a folder of their own.
class CommandLine : public FileTest {
 protected:
  static std::string quoted(const std::string& word) { return "'" + word + "'"; }

  /// Words that start a program on so many ranks. There may be more ranks than cores, so ranks that
  /// wait let the others work.
  static std::vector<std::string> mpirun_on(int n_ranks) {
    return {"mpirun",
            "--quiet",
            "--oversubscribe",
            "--bind-to",
            "none",
            "--mca",
            "mpi_yield_when_idle",
            "1",
            "-np",
            std::to_string(n_ranks)};
  }

  /// Runs `smoothfem words...` in the test's folder.
  Outcome smoothfem(const std::vector<std::string>& words) const {
    std::vector<std::string> command{SMOOTHFEM_PROGRAM};
    command.insert(command.end(), words.begin(), words.end());
    return run(command);
  }

  /// Runs `smoothfem words...` on some ranks of mpirun. The tests may run as root.
  Outcome smoothfem_on_ranks(int n_ranks, const std::vector<std::string>& words) const {
    std::vector<std::string> command{"env", "OMPI_ALLOW_RUN_AS_ROOT=1",
                                     "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"};
    const auto mpirun = mpirun_on(n_ranks);
    command.insert(command.end(), mpirun.begin(), mpirun.end());
    command.push_back(SMOOTHFEM_PROGRAM);
    command.insert(command.end(), words.begin(), words.end());
    return run(command);
  }

 private:
  /// Runs a command in the test's folder.
  Outcome run(const std::vector<std::string>& words) const {
    std::string command = "cd " + quoted(file("").string()) + " &&";
    for (const auto& word : words) command += " " + quoted(word);
    command += " > " + quoted(file(".out").string()) + " 2> " + quoted(file(".err").string());
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(file(".out")),
            content_of(file(".err"))};
  }
};

}  // namespace smoothfem
