// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/loop/plugin.h"
#include "studies/cli/commands.h"

namespace smoothfem {

void add_plugin_option(CLI::App& command) {
  command
      .add_option_function<std::vector<std::string>>(
          "--plugin",
          [](const std::vector<std::string>& libraries) {
            for (const auto& library : libraries) load_plugin(library);
          },
          "shared library with methods of your own (see new-smoother)")
      ->allow_extra_args(false);
}

void add_examples(CLI::App& command, const std::vector<std::string>& lines) {
  std::string text = "Examples:";
  for (const auto& line : lines) text += "\n  " + line;
  command.footer(text);
}

}  // namespace smoothfem
