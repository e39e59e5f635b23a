// SPDX-License-Identifier: GPL-3.0-or-later
/// The commands `check` and `repair`.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "meshes/doctor/examine.h"
#include "meshes/doctor/repair.h"
#include "studies/cli/commands.h"
#include "studies/cli/mesh_notes.h"
#include "studies/cli/piece_commands.h"
#include "studies/cli/standard_streams.h"

namespace smoothfem {

void print_notes(const std::string& path, const std::vector<std::string>& notes) {
  for (const std::string& note : notes)
    std::fprintf(stderr, "smoothfem: note: %s: %s\n", path.c_str(), note.c_str());
}

void warn_about(const std::string& path, const std::vector<Finding>& findings) {
  for (const Finding& finding : findings)
    std::fprintf(stderr, "smoothfem: warning: %s: %s\n", path.c_str(), finding.sentence.c_str());
}

nlohmann::ordered_json json_of(const Finding& finding) {
  nlohmann::ordered_json json = {{"kind", name_of(finding.kind)}, {"count", finding.count}};
  if (finding.node) json["node"] = *finding.node;
  if (finding.cell) json["cell"] = *finding.cell;
  json["at"] = {finding.at.x(), finding.at.y(), finding.at.z()};
  json["repairable"] = finding.is_repairable;
  json["sentence"] = finding.sentence;
  return json;
}

void add_keep_orientation(CLI::App& command, bool& keeps) {
  command.add_flag("--keep-orientation", keeps,
                   "keep cells whose nodes run in the wrong direction, which makes them invalid "
                   "(default: such cells are turned over)");
}

namespace {

constexpr int something_found = 1;

struct DoctorArguments {
  std::string in, from, out;
  bool json = false;
};

/// Calls work(), with the file's name in front of its errors.
template <class Work>
auto about_file(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  }
}

/// Coordinates that are no numbers would be in no plane.
void lay_usable_points_into_plane(MeshParts& parts) {
  require_usable_coordinates(parts);
  lay_into_plane(parts);
}

std::string summary_text(const Examination& seen) {
  return seen.mesh_kind + " mesh, " + count_of(seen.n_nodes, "node") + ", " +
         count_of(seen.n_cells, "cell") + ", " + count_of(seen.n_pieces, "piece");
}

void show_json(const std::string& path, const Examination& seen) {
  nlohmann::ordered_json json = {{"file", path},
                                 {"mesh", seen.mesh_kind},
                                 {"n_nodes", seen.n_nodes},
                                 {"n_cells", seen.n_cells},
                                 {"n_pieces", seen.n_pieces},
                                 {"findings", nlohmann::ordered_json::array()}};
  for (const Finding& finding : seen.findings) json["findings"].push_back(json_of(finding));
  if (!seen.not_looked_for.empty()) json["not_looked_for"] = seen.not_looked_for;
  std::printf("%s\n", json.dump(2).c_str());
}

void show_text(const std::string& path, const Examination& seen) {
  std::printf("%s: %s\n", path.c_str(), summary_text(seen).c_str());
  for (const Finding& finding : seen.findings) std::printf("- %s\n", finding.sentence.c_str());
  for (const std::string& sentence : seen.not_looked_for) std::printf("%s\n", sentence.c_str());
  if (seen.findings.empty())
    std::printf(seen.not_looked_for.empty() ? "nothing is wrong\n"
                                            : "nothing is wrong in what was looked for\n");
}

/// As check(), on all processes of mpirun.
void check_parts(const DoctorArguments& arguments) {
  if (!arguments.from.empty()) throw InputError("--from is for standard input, '-'; leave it out");
  Examination seen;
  if (examine_pieces(arguments.in, seen))
    (arguments.json ? show_json : show_text)(arguments.in, seen);
  if (!seen.findings.empty()) throw ExitCode{something_found};
}

void check(const DoctorArguments& arguments) {
  if (works_in_parts("")) return check_parts(arguments);
  const auto input = copy_of_standard_input(arguments.in, arguments.from);
  MeshParts parts = read_mesh_parts(input ? input->path() : std::filesystem::path(arguments.in));
  print_notes(arguments.in, parts.notes);
  const Examination seen = about_file(arguments.in, [&] {
    lay_usable_points_into_plane(parts);
    return examine(parts);
  });
  (arguments.json ? show_json : show_text)(arguments.in, seen);
  if (!seen.findings.empty()) throw ExitCode{something_found};
}

void repair_file(const DoctorArguments& arguments) {
  require_mesh_path(arguments.out);
  MeshParts parts = read_mesh_parts(arguments.in);
  const auto [done, left] = about_file(arguments.in, [&] {
    lay_usable_points_into_plane(parts);
    auto changes = repair(parts);
    return std::pair(std::move(changes), examine(parts));
  });
  write_mesh(arguments.out, assemble_mesh(arguments.in, std::move(parts)).mesh);
  for (const std::string& change : done) std::printf("%s\n", change.c_str());
  if (done.empty()) std::printf("nothing to repair\n");
  for (const Finding& finding : left.findings) std::printf("left: %s\n", finding.sentence.c_str());
  std::printf("written to %s: %s\n", arguments.out.c_str(), summary_text(left).c_str());
  if (!left.findings.empty()) throw ExitCode{something_found};
}

}  // namespace

void add_check_command(CLI::App& app) {
  auto arguments = std::make_shared<DoctorArguments>();
  auto* command = add_subcommand(app, "check");
  command->add_option("in", arguments->in, "mesh to read; - for standard input")->required();
  command->add_option("--from", arguments->from, "format of standard input: msh, vtu, ...");
  command->add_flag("--json", arguments->json, "as JSON");
  add_examples(*command, {"smoothfem check in.msh", "smoothfem check in.vtu --json"});
  command->callback([arguments] { check(*arguments); });
}

void add_repair_command(CLI::App& app) {
  auto arguments = std::make_shared<DoctorArguments>();
  auto* command = add_subcommand(app, "repair");
  command->add_option("in", arguments->in, "mesh to read")->required();
  command->add_option("-o,--out", arguments->out, "mesh to write")->required();
  add_examples(*command, {"smoothfem repair in.msh -o out.msh"});
  command->callback([arguments] { repair_file(*arguments); });
}

}  // namespace smoothfem
