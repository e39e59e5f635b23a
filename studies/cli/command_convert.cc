// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "meshes/doctor/examine_boundary.h"
#include "meshes/io/atomic_file.h"
#include "meshes/io/losses.h"
#include "meshes/io/mesh_file.h"
#include "meshes/refinement/split_cells.h"
#include "smoothing/quality/mesh_quality.h"
#include "studies/cli/commands.h"
#include "studies/cli/mesh_notes.h"
#include "studies/cli/piece_commands.h"
#include "studies/cli/smooth_notes.h"
#include "studies/cli/standard_streams.h"

namespace smoothfem {

namespace {

struct ConvertArguments {
  std::string in, out, from, to, tag_field;
  std::optional<std::size_t> n_pieces;
  bool keep_orientation = false, quiet = false, refine = false;
};

bool is_in_pieces(const std::string& path) {
  return std::filesystem::path(path).extension() == ".pvtu";
}

void refine_in_pieces(const ConvertArguments& a) {
  const std::pair<bool, const char*> given[]{{a.n_pieces.has_value(), "--pieces"},
                                             {!a.tag_field.empty(), "--tag-field"},
                                             {!a.from.empty(), "--from"},
                                             {!a.to.empty(), "--to"},
                                             {a.keep_orientation, "--keep-orientation"}};
  for (const auto& [is_given, option] : given)
    if (is_given)
      throw InputError(std::string(option) +
                       " does not work with --refine on a mesh in pieces; leave it out");
  refine_pieces(a.in, a.out, a.quiet);
}

AnyMesh refined_mesh(const std::string& path, const MeshFile& file) {
  return std::visit(
      [&]<int dim, int spacedim>(const Mesh<dim, spacedim>& mesh) -> AnyMesh {
        if constexpr (dim == spacedim) {
          require_valid(mesh, path, file.cell_lines);
          for (const Finding& finding : examine_boundary(mesh).findings)
            if (finding.kind == FindingKind::hanging_nodes)
              throw InputError(path + ": " + finding.sentence +
                               "; --refine needs a mesh that conforms");
          print_left_out(path, losses_of_splitting(mesh.topology().labels()));
          return refined(mesh);
        } else {
          throw InputError(path + ": surface meshes cannot be refined; leave out --refine");
        }
      },
      file.mesh);
}

void convert(ConvertArguments arguments) {
  if (arguments.refine && (is_in_pieces(arguments.in) || is_in_pieces(arguments.out)))
    return refine_in_pieces(arguments);
  const bool splits = is_in_pieces(arguments.out);
  if (splits && n_processes() > 1)
    throw InputError("one process divides a whole mesh into pieces; leave out mpirun");
  if (!is_first_process()) return;
  if (arguments.n_pieces && !splits)
    throw InputError("--pieces is for a .pvtu file, not " + arguments.out + "; leave it out");
  const WriteTarget target = parse_write_target(arguments.to);
  const auto input = copy_of_standard_input(arguments.in, arguments.from);
  const auto output = file_for_standard_output(arguments.out, target.extension);
  if (input) arguments.in = input->path();
  if (output) arguments.out = output->path();
  require_extension(arguments.out, arguments.to, target);
  if (splits)
    require_writable_file(arguments.out);
  else
    require_mesh_path(arguments.out);
  MeshFile file = read_mesh(
      arguments.in, {.turns_over = !arguments.keep_orientation, .tag_field = arguments.tag_field});
  print_notes(arguments.in, file.notes);
  if (arguments.refine) file.mesh = refined_mesh(arguments.in, file);
  const MeshView mesh(file.mesh);
  if (splits) {
    split_mesh(file.mesh, arguments.n_pieces.value_or(8), arguments.in, arguments.out);
    print_losses(arguments.out, losses("piece.vtu", mesh, target.options));
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
  command->add_flag("--refine", arguments->refine,
                    "split each cell, for example a tetrahedron into 8; keeps the pieces of a mesh "
                    "in pieces, also on several processes");
  add_keep_orientation(*command, arguments->keep_orientation);
  command->add_flag("--quiet", arguments->quiet, "print nothing but notes and warnings");
  add_examples(*command, {"smoothfem convert in.exo out.vtu", "smoothfem convert in.vtk out.msh",
                          "smoothfem convert in.pvtu finer.pvtu --refine"});
  command->callback([arguments] { convert(*arguments); });
}

}  // namespace smoothfem
