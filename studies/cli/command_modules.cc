// SPDX-License-Identifier: GPL-3.0-or-later
#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>

#include "smoothing/base/input_error.h"
#include "studies/cli/commands.h"
#include "studies/cli/piece_commands.h"

namespace smoothfem {

namespace {

constexpr const char* study_commands = "smoothfem_study_commands.so";
constexpr const char* generate_command = "smoothfem_generate_command.so";
constexpr const char* piece_commands = "smoothfem_piece_commands.so";

/// Returns a function of a module. The module stays loaded, because its libraries have registered
/// the things that users name. Its symbols are global, because Open MPI loads components that need
/// them.
template <class Function>
Function* function_of_module(const char* name, const std::string& function) {
  const auto file = std::filesystem::canonical("/proc/self/exe").parent_path() / name;
  void* module = dlopen(file.c_str(), RTLD_LAZY | RTLD_GLOBAL);
  void* found = module ? dlsym(module, function.c_str()) : nullptr;
  if (!found) throw InputError(std::string(dlerror()) + "; install the program anew");
  return reinterpret_cast<Function*>(found);
}

}  // namespace

bool works_on_pieces(const std::string& mesh) {
  return std::filesystem::path(mesh).extension() == ".pvtu" ||
         std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
}
void smooth_pieces(const SmoothArguments& arguments) {
  function_of_module<void(const SmoothArguments&)>(piece_commands,
                                                   "smoothfem_smooth_pieces")(arguments);
}
void report_pieces(const std::string& mesh, bool as_json) {
  function_of_module<void(const std::string&, bool)>(piece_commands, "smoothfem_report_pieces")(
      mesh, as_json);
}
void generate_box(const BoxArguments& arguments) {
  function_of_module<void(const BoxArguments&)>(piece_commands,
                                                "smoothfem_generate_box")(arguments);
}

const std::vector<Command>& commands() {
  static const std::vector<Command> all{
      {"study", "run a study: tables, figures and meshes; resumes an interrupted run", nullptr,
       study_commands},
      {"smooth", "smooth a mesh file", add_smooth_command},
      {"quality", "quality numbers of a mesh file; exit code 2 if it has invalid cells",
       add_quality_command},
      {"check", "find the faults of a mesh file; exit code 1 if there are any", add_check_command},
      {"repair",
       "repair a mesh file: direction of cells, coincident and unused nodes, doubled cells",
       add_repair_command},
      {"convert", "write a mesh file in another format, and name the losses", add_convert_command},
      {"generate", "generate and distort the mesh of a domain", nullptr, generate_command},
      {"list", "list methods with parameters and sources, presets, studies, domains, formats",
       nullptr, study_commands},
      {"plot", "make tables and figures of a results folder anew", add_plot_command},
      {"report", "make report.html of a results folder anew", add_report_command},
      {"merge", "merge the results folders of one collection, for example of several shards",
       nullptr, study_commands},
      {"new-smoother", "make a folder with the source of a new smoother, ready to build and to run",
       add_new_smoother_command},
      {"new-problem",
       "make a folder with the source of a solver of your equation, ready to build and to run",
       add_new_problem_command},
  };
  return all;
}

void add_command(CLI::App& app, const Command& command, bool with_options) {
  if (command.add)
    command.add(app);
  else if (with_options)
    function_of_module<void(CLI::App&)>(command.module,
                                        "smoothfem_add_" + command.name + "_command")(app);
  else
    add_subcommand(app, command.name);
}

}  // namespace smoothfem
