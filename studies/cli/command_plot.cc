// SPDX-License-Identifier: GPL-3.0-or-later
// Commands that the Python package `plots` carries out. It parses their options itself.
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "meshes/external/child_process.h"
#include "smoothing/base/data_folder.h"
#include "smoothing/base/input_error.h"
#include "studies/cli/commands.h"
#include "studies/cli/plots.h"

namespace smoothfem {

namespace fs = std::filesystem;

std::string plots_command(const std::vector<std::string>& words) {
  // Safe path: otherwise a file copy.py in the user's folder would take the place of Python's
  // module.
  const fs::path find_python = fs::canonical("/proc/self/exe").parent_path() / "find_python";
  std::string command = "python=$(" + shell_quoted(find_python) +
                        ") && PYTHONPATH=" + shell_quoted(data_folder()) +
                        "${PYTHONPATH:+:$PYTHONPATH} PYTHONSAFEPATH=1 "
                        // Compiled files go where they are in nobody's way.
                        "PYTHONPYCACHEPREFIX=\"${XDG_CACHE_HOME:-$HOME/.cache}/smoothfem\" "
                        "exec \"$python\" -m plots";
  for (const std::string& word : words) command += " " + shell_quoted(word);
  return command;
}

namespace {

/// Replaces this process by the package, which gets all further words of the command line.
void add(CLI::App& app, const std::string& name, std::vector<std::string> first_words) {
  auto* command = add_subcommand(app, name);
  command->prefix_command();
  command->set_help_flag();  // the package has its own
  command->callback([command, words = std::move(first_words)] {
    auto all = words;
    for (const std::string& word : command->remaining()) all.push_back(word);
    execl("/bin/sh", "sh", "-c", plots_command(all).c_str(), nullptr);
    throw InputError(std::string("cannot start /bin/sh: ") + std::strerror(errno));
  });
}

}  // namespace

void add_plot_command(CLI::App& app) {
  add(app, "plot", {});
}

void add_report_command(CLI::App& app) {
  add(app, "report", {"report"});
}

}  // namespace smoothfem
