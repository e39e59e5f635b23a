// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "meshes/io/atomic_file.h"
#include "meshes/io/mesh_file.h"
#include "meshes/preparation/prepare_mesh.h"
#include "smoothing/base/interruption.h"
#include "smoothing/base/parallel.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/quality/cell_targets.h"
#include "smoothing/second_order/raise_order.h"
#include "studies/cli/commands.h"
#include "studies/cli/configured_method.h"
#include "studies/cli/mesh_notes.h"
#include "studies/cli/piece_commands.h"
#include "studies/cli/smooth_notes.h"
#include "studies/cli/smooth_report.h"
#include "studies/cli/standard_streams.h"

namespace smoothfem {

namespace {

/// The mesh with the targets that --target asks for.
template <int dim, int spacedim>
Mesh<dim, spacedim> with_target_option(Mesh<dim, spacedim> mesh, const SmoothArguments& arguments) {
  if (arguments.target.empty()) return mesh;
  if constexpr (spacedim > dim) {
    throw InputError("--target is for planar and volume meshes; leave it out");
  } else {
    if (const auto kind = initial_target(arguments.target))
      return with_initial_targets(mesh, *kind);
    if (!std::filesystem::exists(arguments.target))
      throw InputError("--target is '" + arguments.target +
                       "', which is no file; give initial, initial-size or a mesh file");
    const MeshFile file = read_mesh(arguments.target);
    return with_cells_as_targets(mesh, file.mesh, arguments.in, arguments.target);
  }
}

struct Outcome {
  std::string method_title;
  SmoothingResult smoothing;
};

/// Throws InputError if an output file would replace one of the command's meshes.
void require_different_files(const SmoothArguments& arguments) {
  namespace fs = std::filesystem;
  const auto is_same = [](const fs::path& a, const fs::path& b) {
    std::error_code ignored;  // paths that do not exist are compared by name
    return fs::equivalent(a, b, ignored) || fs::weakly_canonical(fs::absolute(a), ignored) ==
                                                fs::weakly_canonical(fs::absolute(b), ignored);
  };
  const std::pair<const char*, const fs::path> others[] = {{"--log", arguments.log},
                                                           {"--series", arguments.series}};
  for (const auto& [option, path] : others) {
    if (path.empty()) continue;
    if (is_same(path, arguments.in) || is_same(path, arguments.out))
      throw InputError(std::string(option) + " names " + path.string() +
                       ", which is a mesh of this command; give another file name");
  }
  if (!arguments.log.empty() && !arguments.series.empty() &&
      is_same(arguments.log, arguments.series))
    throw InputError("--log and --series name the same file " + arguments.log +
                     "; give two file names");
}

/// Prints the sentences of the preparation.
NoteTaker printed_notes(const SmoothArguments& arguments) {
  return {.warn =
              [&](const std::string& sentence) {
                std::fprintf(stderr, "smoothfem: warning: %s: %s\n", arguments.in.c_str(),
                             sentence.c_str());
              },
          .note = [&](const std::string& sentence) { print_notes(arguments.in, {sentence}); },
          .tell =
              [&](const std::string& sentence) {
                if (!arguments.quiet) std::printf("%s\n", sentence.c_str());
              }};
}

/// Throws InputError if a stage needs a valid mesh and this one is not, unless it is untangled.
template <int dim, int spacedim>
void require_valid_if_needed(const SmoothArguments& arguments, const Method<dim, spacedim>& method,
                             const Mesh<dim, spacedim>& mesh,
                             const std::vector<std::size_t>& cell_lines) {
  const bool needs_valid =
      std::any_of(method.stages.begin(), method.stages.end(),
                  [](const auto& stage) { return stage->traits().needs_valid_mesh; });
  if (!needs_valid || arguments.untangle) return;
  if (mesh.topology().midside())  // curved cells of valid corners are repaired
    require_valid(with_linear_cells(mesh), arguments.in, cell_lines);
  else
    require_valid(mesh, arguments.in, cell_lines);
}

/// Smooths a mesh. The method and its tables are freed before the mesh is written: writing needs
/// memory, too.
template <int dim, int spacedim>
Outcome smooth_by_method(Method<dim, spacedim> method, const SmoothArguments& arguments,
                         Mesh<dim, spacedim>& mesh, const std::vector<std::size_t>& cell_lines,
                         Recorder& recorder) {
  require_valid_if_needed(arguments, method, mesh, cell_lines);
  untangle_as_asked(arguments, method, arguments.in, printed_notes(arguments), mesh);
  mesh = with_target_option(std::move(mesh), arguments);
  if (!arguments.allow_worse) method.floor = 1;
  Observer<dim, spacedim>
      observer;  // empty without --log and --series, because it costs a pass over all cells
  if (recorder.records())
    observer = [&](const auto& record, const auto& now) { recorder.observe(record, now); };
  use_folders(method, {});
  try {
    return {method.info.title, smooth_prepared(mesh, method, arguments, observer)};
  } catch (const Interrupted&) {
    recorder.write_log();
    std::fprintf(stderr, "Interrupted: no mesh is written%s%s.\n",
                 arguments.log.empty() ? "" : "; the rows so far are in ", arguments.log.c_str());
    throw;
  } catch (const SmootherFailure& failure) {
    throw InputError("the method " + method.info.name + " failed: " + failure.what());
  }
}

/// The mesh without reasons to stay for periodic nodes that have moved. Says whether any has.
template <int dim, int spacedim>
Mesh<dim, spacedim> with_moved_partners(Mesh<dim, spacedim> mesh,
                                        const std::vector<Point<spacedim>>& initial) {
  auto reasons = mesh.topology().fixed_reasons();
  std::size_t n_moved = 0;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    if (has(reasons[i], FixedReason::periodic) &&
        std::as_const(mesh).coordinates()[i] != initial[i]) {
      reasons[i] = 0;
      ++n_moved;
    }
  std::printf(n_moved == 0 ? "no periodic partner has moved\n"
                           : "%zu periodic nodes have moved together with their partners\n",
              n_moved);
  return with_fixed_nodes(std::move(mesh), std::move(reasons));
}

template <int dim, int spacedim>
void smooth_mesh(const SmoothArguments& arguments, Mesh<dim, spacedim> mesh,
                 const std::vector<std::size_t>& cell_lines, const MeshWriteOptions& options) {
  // Otherwise Ctrl-C ends the process at once.
  if (!arguments.log.empty() || method_in_file(arguments.method)) notice_signals();
  auto method = configured_method<dim, spacedim>(arguments);
  const auto topology_of_file = mesh.shared_topology();
  mesh = prepared_mesh(std::move(mesh), arguments, printed_notes(arguments));
  const MeshQuality before = mesh_quality(mesh);
  const std::vector<double> sizes_before = cell_sizes(mesh);
  std::vector<Point<spacedim>> initial;  // empty if periodic partners stay
  if (dim == spacedim && moves_partners(mesh.topology(), arguments.rules()))
    initial = mesh.copied_coordinates();
  Recorder recorder(arguments);
  const Outcome outcome =
      smooth_by_method(std::move(method), arguments, mesh, cell_lines, recorder);
  const bool has_targets = mesh.targets() != nullptr;
  MeshFields fields;
  if (has_targets) fields.cell["target_mean_ratio"] = cell_mean_ratios(mesh);
  mesh = without_targets(mesh);
  report_midside(outcome.smoothing.midside, arguments.quiet);
  report_floor(outcome.method_title, outcome.smoothing, mesh.n_cells(), arguments.quiet);
  warn_about_invalid_cells(arguments, outcome.smoothing.quality.n_invalid, mesh.n_cells());
  fields.cell["mean_ratio"] = cell_mean_ratios(mesh);
  // Mesh files do not store that a boundary slides, so its nodes are fixed there.
  write_mesh(arguments.out,
             arguments.slides() || arguments.only_below || arguments.periodic == "smooth"
                 ? Mesh<dim, spacedim>(topology_of_file, mesh.copied_coordinates(),
                                       mesh.shared_constraints())
                 : mesh,
             fields, options);
  recorder.write_log();
  print_losses(arguments.out, mesh, options);
  const std::vector<double> sizes = cell_sizes(mesh);
  const std::string change = domain_change(dim == 3 ? "volume" : "area", sizes_before, sizes);
  if (!change.empty()) print_notes(arguments.out, {change});
  if (arguments.quiet) return;
  std::printf("%-8s %9s %9s %9s %9s\n", "", "q_min", "q*_min", "q_mean", "invalid");
  print_quality("before", before);
  print_quality("after", has_targets ? mesh_quality(mesh) : outcome.smoothing.quality);
  if (has_targets) print_quality("to target", outcome.smoothing.quality);
  std::printf(
      "%s: %s iterations in %.4g s, and %.4g s of preparation, on %d threads; written to %s\n",
      outcome.method_title.c_str(), outcome.smoothing.iterations_text().c_str(),
      outcome.smoothing.smoothing_seconds, outcome.smoothing.preparation_seconds, n_threads(),
      arguments.out.c_str());
  print_stages(outcome.smoothing, mesh.topology().free_nodes().size());
  if (!initial.empty()) mesh = with_moved_partners(std::move(mesh), initial);
  for (const std::string& line :
       {fixed_reasons_text(mesh.topology()), size_changes(sizes_before, sizes),
        fields_text(mesh.topology().labels().content.get())})
    if (!line.empty()) std::printf("%s\n", line.c_str());
  if constexpr (dim == spacedim)
    // Curved facets follow the initial ones, which the distance of straight facets does not say.
    if (const auto* constraints = mesh.constraints(); constraints && !mesh.topology().midside())
      std::printf("distance from the initial %s: %.3g (limit: %.3g)\n",
                  arguments.boundary == "slide" ? "boundary" : "interfaces",
                  constraints->facet_distance(mesh.coordinates()), constraints->facet_bound());
}

/// Returns the default output path: "part_smoothed.msh" in the same folder for "part.msh".
std::string default_output(const std::string& in, const std::string& extension) {
  if (in == "-") return in;
  std::filesystem::path path = in;
  const std::string name = path.stem().string() + "_smoothed" +
                           (extension.empty() ? extension_to_write(path) : extension);
  return path.replace_filename(name);
}

void smooth_file(SmoothArguments arguments) {
  // The option may have taken the mesh for its value.
  if (arguments.in.empty() && arguments.keep_layers &&
      !arguments.keep_layers->starts_with("group="))
    std::swap(arguments.in, *arguments.keep_layers);
  if (!arguments.fix_rule.empty()) arguments.fix = parse_fixed_nodes_rule(arguments.fix_rule);
  arguments.has_target = !arguments.target.empty();
  if (arguments.in.empty()) throw CLI::RequiredError("in");
  if (works_in_parts(arguments.out)) return smooth_pieces(arguments);
  if (!arguments.solution.empty() || arguments.resume)
    throw InputError(
        std::string(arguments.resume ? "--resume" : "--solution") +
        " works on a mesh in parts; start the command by 'mpirun -np 1' or more, or write a study, "
        "which records finite elements on a whole mesh");
  const WriteTarget target = parse_write_target(arguments.to);
  if (arguments.out.empty()) arguments.out = default_output(arguments.in, target.extension);
  if (arguments.n_threads > 0) set_n_threads(arguments.n_threads);
  const auto input = copy_of_standard_input(arguments.in, arguments.from);
  const auto output = file_for_standard_output(arguments.out, target.extension);
  if (input) arguments.in = input->path();
  if (output) {
    arguments.out = output->path();
    arguments.quiet = true;  // standard output is the mesh
  }
  require_extension(arguments.out, arguments.to, target);
  require_different_files(arguments);
  require_mesh_path(arguments.out);
  if (!arguments.log.empty()) require_writable_file(arguments.log);
  MeshFile file = read_mesh(arguments.in, {.turns_over = !arguments.keep_orientation,
                                           .merges = arguments.merge,
                                           .tag_field = arguments.tag_field});
  print_notes(arguments.in, file.notes);
  std::visit(
      [&](auto& mesh) { smooth_mesh(arguments, std::move(mesh), file.cell_lines, target.options); },
      file.mesh);
  if (output) print_content(output->path());
}

}  // namespace

void add_smooth_command(CLI::App& app) {
  auto arguments = std::make_shared<SmoothArguments>();
  auto* command = add_subcommand(app, "smooth");
  command->add_option("in", arguments->in, "mesh to read (required); - for standard input");
  command->add_option("-m,--method", arguments->method,
                      "method (see 'list'), or python:FILE:CLASS");
  command->add_option("-o,--out", arguments->out,
                      "mesh to write; - for standard output (default: IN_smoothed, or - for -)");
  command->add_option("--from", arguments->from, "format of standard input: msh, vtu, ...");
  command->add_option(
      "--to", arguments->to,
      "format to write: vtu, msh, ...; msh22 or msh41 also with -text or -binary (default: version "
      "and encoding of IN if the formats are the same)");
  command->add_option(
      "--tag-field", arguments->tag_field,
      "cell array of a .vtk or .vtu file with the cells' tags (default: the first of "
      "physical_tag, gmsh:physical, MaterialID, material, attribute, CellEntityIds)");
  command->add_option("--preset", arguments->preset,
                      "parameters of an experiment (see 'list'); --set comes after it");
  command->add_option("--set", arguments->settings, "parameter of the method: key=value")
      ->allow_extra_args(false);
  command->add_option(
      "--fix", arguments->fix_rule,
      "nodes that stay: boundary, file, free or group=NAME[,NAME] (default: as in the file, "
      "otherwise the boundary); group= adds to the default");
  command
      ->add_option("--interfaces", arguments->interfaces,
                   "nodes between cells of different groups, and of labelled inner facets: fixed "
                   "(default), slide on the interface, or free")
      ->check(CLI::IsMember({"fixed", "slide", "free"}));
  command
      ->add_option("--keep-layers", arguments->keep_layers,
                   "keep thin cells (aspect ratio above 10) in layers along the boundary, or along "
                   "group=NAME")
      ->expected(0, 1)
      ->default_str("");
  command->add_option(
      "--feature-angle", arguments->feature_angle,
      "keep edges of a surface or of a sliding boundary whose facets make more than this "
      "angle (degrees; default: 40)");
  command
      ->add_option(
          "--boundary", arguments->boundary,
          "boundary nodes: fixed (default), or slide on the initial boundary, in space along its "
          "edges; corners stay")
      ->check(CLI::IsMember({"fixed", "slide"}));
  command->add_option(
      "--slide-distance", arguments->slide_distance,
      "maximum distance of a sliding boundary from the initial one, as a fraction of its "
      "mean edge length (default: 0.1; inf: no bound)");
  command
      ->add_option("--periodic", arguments->periodic,
                   "nodes with periodic partners: fixed (default; with --boundary slide they slide "
                   "together), or smooth as if both sides were joined")
      ->check(CLI::IsMember({"fixed", "smooth"}));
  command->add_option("--target", arguments->target,
                      "ideal shape and size of each cell: those of IN (initial), the size of IN "
                      "with a regular shape (initial-size), or those of a mesh file with the same "
                      "cells (default: a regular shape of any size)");
  command->add_flag(
      "--untangle", arguments->untangle,
      "make a tangled mesh valid first; with --boundary slide boundary nodes slide, too");
  command->add_option("--threads", arguments->n_threads, "number of threads (default: all cores)")
      ->check(CLI::Range(1, 1024));
  auto* const log =
      command->add_option("--log", arguments->log, "CSV file with one row per iteration");
  auto* const solution = command
                             ->add_option("--solution", arguments->solution,
                                          "on a mesh in parts: solve finite elements of degree 1 "
                                          "for this solution (see 'list') after every iteration, "
                                          "and add their errors and costs to the rows of --log")
                             ->needs(log);
  command
      ->add_option("--finite-elements", arguments->finite_elements,
                   "key=value, as in the subsection 'finite elements' of studies, for example "
                   "multigrid cg=always (default: condition number=lanczos)")
      ->allow_extra_args(false)
      ->needs(solution);
  command
      ->add_flag("--resume", arguments->resume,
                 "on a mesh in parts: keep the rows that --log has from an interrupted run of this "
                 "command, and solve only after them")
      ->needs(solution);
  command->add_option("--series", arguments->series, "VTU series (.pvd) with every iteration");
  command
      ->add_option(
          "--only-below", arguments->only_below,
          "smooth only around cells with a lower mean ratio than this; all other nodes stay")
      ->check(CLI::Range(0.0, 1.0));
  command
      ->add_option(
          "--rings", arguments->rings,
          "with --only-below: rings of cells around bad cells whose nodes also move (default: 2)")
      ->check(CLI::Range(0, 1000));
  command->add_flag("--merge", arguments->merge,
                    "merge boundary nodes that lie in one place, for example on the seam between "
                    "the parts of a parallel program");
  add_keep_orientation(*command, arguments->keep_orientation);
  command->add_flag("--fail-if-invalid", arguments->fail_if_invalid,
                    "write nothing and exit with 2 if the smoothed mesh has invalid cells");
  command->add_flag("--allow-worse", arguments->allow_worse,
                    "keep the method's result even if its worst cell is worse than that of IN");
  command->add_flag("--quiet", arguments->quiet, "print nothing but warnings");
  add_plugin_option(*command);
  add_examples(
      *command,
      {"smoothfem smooth in.vtu -m getme -o out.vtu",
       "smoothfem smooth in.msh -m getme-simultaneous --set lambda=0.4 -o out.msh --log rows.csv",
       "smoothfem smooth in.mesh -m smart-laplace --only-below 0.3 -o out.mesh"});
  command->callback([arguments] { smooth_file(*arguments); });
}

}  // namespace smoothfem
