// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace smoothfem {

/// Each function adds one subcommand to the program. The commands' callbacks throw InputError.
void add_smooth_command(CLI::App& app);
void add_quality_command(CLI::App& app);
void add_check_command(CLI::App& app);
void add_repair_command(CLI::App& app);
void add_convert_command(CLI::App& app);
void add_list_command(CLI::App& app);
void add_new_smoother_command(CLI::App& app);
void add_new_problem_command(CLI::App& app);
void add_plot_command(CLI::App& app);
void add_report_command(CLI::App& app);
void add_complete_command(CLI::App& app);

/// The commands of the modules, found by their names when the module is loaded.
extern "C" {
void smoothfem_add_study_command(CLI::App& app);
void smoothfem_add_generate_command(CLI::App& app);
void smoothfem_add_merge_command(CLI::App& app);
}

/// The modules: files next to the program.
inline constexpr const char* study_module = "smoothfem_study_commands.so";
inline constexpr const char* generate_module = "smoothfem_generate_command.so";

/// Loads a module, and returns what dlsym takes. It stays loaded, because its libraries have
/// registered the things that users name. Its symbols are global, because Open MPI loads components
/// that need them. Throws InputError if the module is missing.
void* load_module(const char* module);

/// Returns a function of a module, which is loaded for it.
void* function_of_module(const char* module, const std::string& name);

/// Thrown by a command's callback to end the program with an exit code other than 0, for example
/// after a report.
struct ExitCode {
  int code;
};

/// A command as `smoothfem --help` lists it.
struct Command {
  std::string name, description;
  void (*add)(CLI::App&);   ///< null: the command is in a module
  const char* module = "";  ///< it has the command
};

/// All commands, in the order of the help.
const std::vector<Command>& commands();

/// Adds a command. with_options: with all its options, for which the command's module is loaded.
/// Throws InputError if the module is missing.
void add_command(CLI::App& app, const Command& command, bool with_options);

/// Adds the subcommand of this name to the program, with its description in commands().
CLI::App* add_subcommand(CLI::App& app, const std::string& name);

/// Adds --plugin, which loads libraries of methods before the command runs.
/// module: is loaded before them, because they may register things of its libraries, too.
void add_plugin_option(CLI::App& command, const char* module = nullptr);

/// Adds example command lines to the end of the command's help.
void add_examples(CLI::App& command, const std::vector<std::string>& lines);

}  // namespace smoothfem
