// SPDX-License-Identifier: GPL-3.0-or-later
#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>

#include "smoothing/base/input_error.h"
#include "studies/cli/commands.h"
#include "studies/cli/piece_commands.h"

namespace smoothfem {

namespace {

constexpr const char* piece_module = "smoothfem_piece_commands.so";

/// Calls a function of the module of meshes in pieces.
template <class... Arguments>
void call_on_pieces(const char* function, Arguments&... arguments) {
  reinterpret_cast<void (*)(Arguments & ...)>(function_of_module(piece_module, function))(
      arguments...);
}

}  // namespace

void* load_module(const char* module) {
  const auto folder = std::filesystem::canonical("/proc/self/exe").parent_path();
  // First of all Gmsh, if both are needed: its hundred libraries then look their symbols up only in
  // each other, not in those of deal.II, too.
  if (module == std::string(study_module))
    dlopen((folder / generate_module).c_str(), RTLD_LAZY | RTLD_LOCAL);
  void* loaded = dlopen((folder / module).c_str(), RTLD_LAZY | RTLD_GLOBAL);
  if (!loaded) throw InputError(std::string(dlerror()) + "; install the program anew");
  return loaded;
}

void* function_of_module(const char* module, const std::string& name) {
  void* function = dlsym(load_module(module), name.c_str());
  if (!function) throw InputError(std::string(dlerror()) + "; install the program anew");
  return function;
}

bool works_in_parts(const std::string& out) {
  return std::filesystem::path(out).extension() == ".pvtu" ||
         std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
}
int n_processes() {
  const char* const size = std::getenv("OMPI_COMM_WORLD_SIZE");
  return size == nullptr ? 1 : std::atoi(size);
}
bool is_first_process() {
  const char* const rank = std::getenv("OMPI_COMM_WORLD_RANK");
  return rank == nullptr || std::atoi(rank) == 0;
}
void smooth_pieces(const SmoothArguments& arguments) {
  call_on_pieces("smoothfem_smooth_pieces", arguments);
}
void report_pieces(const std::string& mesh, bool as_json) {
  call_on_pieces("smoothfem_report_pieces", mesh, as_json);
}
bool examine_pieces(const std::string& mesh, Examination& seen) {
  bool is_first = true;
  call_on_pieces("smoothfem_examine_pieces", mesh, seen, is_first);
  return is_first;
}
void split_mesh(const AnyMesh& mesh, std::size_t n_pieces, const std::string& in,
                const std::string& out) {
  call_on_pieces("smoothfem_split_mesh", mesh, n_pieces, in, out);
}
void refine_pieces(const std::string& in, const std::string& out, bool quiet) {
  call_on_pieces("smoothfem_refine_pieces", in, out, quiet);
}
void generate_box(const BoxArguments& arguments) {
  call_on_pieces("smoothfem_generate_box", arguments);
}

const std::vector<Command>& commands() {
  static const std::vector<Command> all{
      {"study", "run a study: tables, figures and meshes; resumes an interrupted run", nullptr,
       study_module},
      {"smooth", "smooth a mesh file", add_smooth_command},
      {"quality", "quality numbers of a mesh file; exit code 2 if it has invalid cells",
       add_quality_command},
      {"check", "find the faults of a mesh file; exit code 1 if there are any", add_check_command},
      {"repair",
       "repair a mesh file: direction of cells, coincident and unused nodes, doubled cells",
       add_repair_command},
      {"convert", "write a mesh file in another format, and name the losses", add_convert_command},
      {"generate", "generate and distort the mesh of a domain", nullptr, generate_module},
      {"list", "list methods with parameters and sources, presets, studies, domains, formats",
       add_list_command},
      {"plot", "make tables and figures of a results folder anew", add_plot_command},
      {"report", "make report.html of a results folder anew", add_report_command},
      {"merge", "merge the results folders of one collection, for example of several shards",
       nullptr, study_module},
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
    reinterpret_cast<void (*)(CLI::App&)>(
        function_of_module(command.module, "smoothfem_add_" + command.name + "_command"))(app);
  else
    add_subcommand(app, command.name);
}

}  // namespace smoothfem
