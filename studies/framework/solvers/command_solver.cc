// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "fem/solvers/mesh_solver.h"
#include "meshes/external/command_line.h"
#include "meshes/external/external_program.h"
#include "meshes/external/text_vtk.h"
#include "meshes/io/mesh_file.h"
#include "smoothing/base/text.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;

constexpr const char* out_file = "out.json";
constexpr const char* need = ", such as 'set command = ./solve {in} {out}'";

/// True for the names of columns: a letter, then letters, digits and '_'.
bool is_number_name(const std::string& name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return !name.empty() && is_letter(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

/// An external program as a solver. It reads the mesh from a file, and gives its numbers as JSON or
/// in what it prints.
template <int dim>
class CommandSolver final : public MeshSolver<dim> {
 public:
  /// The program gets the mesh with its hanging nodes, periodic partners and midside nodes.
  SolverTraits traits() const override { return {.takes_ties = true, .takes_curved_cells = true}; }

  Parameters parameters() override {
    return {
        {"command",
         "program with its options, run by /bin/sh in an empty folder; {in} is its mesh file, "
         "{out} the JSON file that it writes, {folder} the base of relative file names",
         &program_.command},
        {"format",
         "format of {in}: vtk (legacy, as text), vtu, msh (4.1, as text), msh22, inp, mesh; with "
         "'-binary' or '-text' for another encoding",
         &format_},
        {"files", "files to copy next to {in}, separated by commas", &program_.files},
        {"version_command", "command that prints the program's version, for the provenance",
         &program_.version_command},
        {"timeout", "largest time of a run, in seconds", &program_.timeout, 0.0, 1e9, true}};
  }

  std::vector<std::string> keyed_parameters() const override {
    return {"number", "unit", "meaning"};
  }

  void set_keyed(const std::string& parameter, const std::string& name,
                 const std::string& value) override {
    if (!is_number_name(name))
      throw InputError("'" + parameter + " " + name +
                       "' has no name of a column: a letter, then letters, digits and '_'");
    if (parameter == "number")
      patterns_.emplace(name, LinePattern("pattern of the number " + name, value));
    else if (parameter == "unit")
      units_[name] = value;
    else
      meanings_[name] = value;
  }

  void check_parameters() const override {
    if (program_.command.empty())
      throw InputError("the solver needs a command" + std::string(need));
    if (!has_placeholder(program_.command, "in"))
      throw InputError("the command '" + program_.command +
                       "' has no {in} for the file of its mesh" + need);
    if (patterns_.empty() && !has_placeholder(program_.command, "out"))
      throw InputError("the command '" + program_.command +
                       "' gives no numbers: it needs {out}, a JSON file that it writes, or keys "
                       "such as 'set number u_max = largest u: ([-+0-9.e]+)'");
    require_mesh_path(in_file());
  }

  void use_folders(const SmootherFolders& folders) override { program_.folders = folders; }
  SmootherOrigin origin() override {
    try {
      return program_.origin();
    } catch (const SmootherFailure&) {  // the solver will fail and report it
      return {};
    }
  }

  std::vector<NumberDescription> numbers() const override {
    std::map<std::string, NumberDescription> all;
    const auto at = [&](const std::string& name) -> NumberDescription& {
      auto& number = all[name];
      number.name = name;
      return number;
    };
    for (const auto& [name, pattern] : patterns_) at(name);
    for (const auto& [name, unit] : units_) at(name).unit = unit;
    for (const auto& [name, meaning] : meanings_) at(name).description = meaning;
    std::vector<NumberDescription> numbers;
    for (auto& [name, number] : all) numbers.push_back(std::move(number));
    return numbers;
  }

  void initialize(const Mesh<dim>& mesh, int /*degree*/) override {
    if (format_ == "vtk" && mesh.topology().midside() != nullptr)
      throw InputError(
          "the format 'vtk' of its mesh file has linear cells only, but the mesh has cells of "
          "second order; write 'set format = vtu' or 'set format = msh' for the solver");
  }

  SolverResult solve(const Mesh<dim>& mesh) override {
    const ScratchFolder scratch;
    write_input(mesh, scratch.path());
    (void)program_.path();
    const CommandEnd end = program_.run_to_success(
        program_.filled_in(program_.command, {{"in", in_file()}, {"out", out_file}}),
        scratch.path());
    SolverResult result;
    if (has_placeholder(program_.command, "out"))
      read_json(program_.left_file(scratch.path(), out_file), result);
    for (const auto& [name, pattern] : patterns_) {
      const auto groups = pattern.groups_in(end.output);
      if (groups.empty())
        throw SolverFailure("it printed nothing for " + pattern.name() +
                            program_.last_output_text());
      add(name, number_in(groups.back(), name), result);
    }
    return result;
  }

 private:
  std::string in_file() const {
    return format_ == "vtk" ? "in.vtk" : "in" + parse_write_target(format_).extension;
  }

  void write_input(const Mesh<dim>& mesh, const fs::path& folder) const {
    if (format_ == "vtk") {
      write_text_vtk(folder / in_file(), mesh);
    } else {
      MeshWriteOptions options = parse_write_target(format_).options;
      if (!options.msh_version) options.msh_version = MshVersion::v4_1;
      if (!options.binary) options.binary = false;
      write_mesh(folder / in_file(), mesh, {}, options);
    }
    program_.copy_files(folder);
  }

  static double number_in(const std::string& text, const std::string& name) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end == text.c_str() || !std::isfinite(value))
      throw SolverFailure("it printed '" + shortened(text) + "' as " + name +
                          ", which is not a finite number");
    return value;
  }

  static void add(const std::string& name, double value, SolverResult& result) {
    for (const auto& known : result.numbers)
      if (known.name == name) throw SolverFailure("it gives the number " + name + " twice");
    result.numbers.push_back({name, value});
  }

  /// Reads {"NAME": number, ...}.
  static void read_json(const fs::path& path, SolverResult& result) {
    nlohmann::json json;
    try {
      std::ifstream stream(path);
      json = nlohmann::json::parse(stream);
    } catch (const nlohmann::json::exception&) {
      throw SolverFailure("the file " + std::string(out_file) + " that it wrote is no JSON");
    }
    if (!json.is_object() || json.empty())
      throw SolverFailure("the file " + std::string(out_file) +
                          " that it wrote has no numbers, such as {\"u_max\": 1.5}");
    for (const auto& [name, value] : json.items()) {
      if (!is_number_name(name))
        throw SolverFailure("it gives a number the name '" + shortened(name) +
                            "', which is not a letter, then letters, digits and '_'");
      if (!value.is_number() || !std::isfinite(value.template get<double>()))
        throw SolverFailure("it gives " + name + " a value that is not a finite number");
      add(name, value.template get<double>(), result);
    }
  }

  ExternalProgram program_;
  std::string format_ = "vtu";
  std::map<std::string, LinePattern> patterns_;
  std::map<std::string, std::string> units_, meanings_;
};

const RegisteredSolver registered({.name = "command",
                                   .title = "Command",
                                   .description = "an external program, which reads the mesh from "
                                                  "a file and gives numbers",
                                   .source = "the external program"},
                                  solver_in_plane_and_space<CommandSolver>());

}  // namespace
}  // namespace smoothfem
