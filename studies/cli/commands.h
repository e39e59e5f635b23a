// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace smoothfem {

/// Each adds one subcommand to the program. Their callbacks throw InputError.
void add_smooth_command(CLI::App& app);
void add_quality_command(CLI::App& app);
void add_study_command(CLI::App& app);
void add_generate_command(CLI::App& app);
void add_list_command(CLI::App& app);
void add_merge_command(CLI::App& app);
void add_new_smoother_command(CLI::App& app);

/// --plugin, which loads libraries of methods before the command runs.
void add_plugin_option(CLI::App& command);

/// Command lines that its help ends with.
void add_examples(CLI::App& command, const std::vector<std::string>& lines);

}  // namespace smoothfem
