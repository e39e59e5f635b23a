// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

namespace smoothfem {

/// Each adds one subcommand to the program. Their callbacks throw InputError.
void add_smooth_command(CLI::App& app);
void add_quality_command(CLI::App& app);
void add_study_command(CLI::App& app);
void add_generate_command(CLI::App& app);
void add_list_command(CLI::App& app);

}  // namespace smoothfem
