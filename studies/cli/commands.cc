// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/cli/commands.h"

#include <algorithm>

#include "smoothing/loop/plugin.h"

namespace smoothfem {

CLI::App* add_subcommand(CLI::App& app, const std::string& name) {
  const auto known = std::find_if(commands().begin(), commands().end(),
                                  [&](const Command& command) { return command.name == name; });
  return app.add_subcommand(name, known->description);
}

void add_plugin_option(CLI::App& command, const char* module) {
  command
      .add_option_function<std::vector<std::string>>(
          "--plugin",
          [module](const std::vector<std::string>& libraries) {
            if (module) load_module(module);
            for (const auto& library : libraries) load_plugin(library);
          },
          "shared library with your methods (see new-smoother)")
      ->allow_extra_args(false);
}

void add_examples(CLI::App& command, const std::vector<std::string>& lines) {
  std::string text = "Examples:";
  for (const auto& line : lines) text += "\n  " + line;
  command.footer(text);
}

}  // namespace smoothfem
