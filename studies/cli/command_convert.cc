// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <filesystem>
#include <memory>

#include "meshes/io/atomic_file.h"
#include "meshes/io/mesh_file.h"
#include "studies/cli/commands.h"
#include "studies/cli/mesh_notes.h"
#include "studies/cli/piece_commands.h"
#include "studies/cli/smooth_notes.h"
#include "studies/cli/standard_streams.h"

namespace smoothfem {

namespace {

struct ConvertArguments {
  std::string in, out, from, to, tag_field;
  std::size_t n_pieces = 8;
  bool keep_orientation = false, quiet = false;
};

void convert(ConvertArguments arguments) {
  const WriteTarget target = parse_write_target(arguments.to);
  const auto input = copy_of_standard_input(arguments.in, arguments.from);
  const auto output = file_for_standard_output(arguments.out, target.extension);
  if (input) arguments.in = input->path();
  if (output) arguments.out = output->path();
  require_extension(arguments.out, arguments.to, target);
  const bool splits = std::filesystem::path(arguments.out).extension() == ".pvtu";
  if (splits)
    require_writable_file(arguments.out);
  else
    require_mesh_path(arguments.out);
  const MeshFile file = read_mesh(
      arguments.in, {.turns_over = !arguments.keep_orientation, .tag_field = arguments.tag_field});
  print_notes(arguments.in, file.notes);
  const MeshView mesh(file.mesh);
  if (splits) {
    split_mesh(file.mesh, arguments.n_pieces, arguments.out);
    print_losses("piece.vtu", mesh, target.options);
  } else {
    write_mesh(arguments.out, mesh, {}, target.options);
    print_losses(arguments.out, mesh, target.options);
  }
  if (output)
    print_content(output->path());
  else if (!arguments.quiet)
    std::printf("%s mesh, %s, %s; written to %s\n", kind_name(file.mesh),
                count_of(mesh.n_nodes(), "node").c_str(), count_of(mesh.n_cells(), "cell").c_str(),
                arguments.out.c_str());
}

}  // namespace

void add_convert_command(CLI::App& app) {
  auto arguments = std::make_shared<ConvertArguments>();
  auto* command = add_subcommand(app, "convert");
  command->add_option("in", arguments->in, "mesh to read; - for standard input")->required();
  command->add_option("out", arguments->out, "mesh to write; - for standard output")->required();
  command->add_option("--from", arguments->from, "format of standard input: msh, vtu, ...");
  command->add_option("--to", arguments->to,
                      "format to write: vtu, msh, ...; msh22 or msh41 also with -text or -binary");
  command->add_option("--tag-field", arguments->tag_field,
                      "cell array of a .vtk or .vtu file with the cells' tags");
  command
      ->add_option("--pieces", arguments->n_pieces, "number of files of a .pvtu mesh (default: 8)")
      ->check(CLI::Range(1, 9999));
  add_keep_orientation(*command, arguments->keep_orientation);
  command->add_flag("--quiet", arguments->quiet, "print nothing but notes and warnings");
  add_examples(*command, {"smoothfem convert in.exo out.vtu", "smoothfem convert in.vtk out.msh"});
  command->callback([arguments] { convert(*arguments); });
}

}  // namespace smoothfem
