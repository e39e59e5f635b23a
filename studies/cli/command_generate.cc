// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <memory>
#include <optional>

#include "meshes/distortion/distort.h"
#include "meshes/domains/catalogue.h"
#include "meshes/io/mesh_file.h"
#include "meshes/preparation/prepare_mesh.h"
#include "smoothing/quality/mesh_quality.h"
#include "studies/cli/commands.h"
#include "studies/cli/list_parts.h"
#include "studies/cli/piece_commands.h"
#include "studies/cli/standard_streams.h"

namespace smoothfem {

namespace {

struct GenerateArguments {
  std::string domain, out, to, elements, algorithm;
  std::string distortion = distortion_kind_names[0];
  double edge_scale = 1.0, distort_to = 0.0, min_quality = 0.0;
  std::optional<double> eps;
  int sweeps = 1, order = 1;
  std::uint64_t seed = 1;
  bool quiet = false, list = false;
  BoxArguments box;
};

template <int dim, int spacedim>
void distort_as_asked(Mesh<dim, spacedim>& mesh, const GenerateArguments& arguments) {
  if (arguments.distort_to == 0.0) return;
  DistortionParameters parameters;
  parameters.target_q_mean = arguments.distort_to;
  parameters.seed = arguments.seed;
  parameters.n_candidates = default_candidates(dim);
  parameters.n_sweeps = arguments.sweeps;
  parameters.min_quality = arguments.min_quality;
  if (arguments.distortion == distortion_kind_names[1])
    parameters.kind = DistortionKind::random_steps;
  distort(mesh, parameters);
}

template <int dim, int spacedim>
void write(const Mesh<dim, spacedim>& mesh, const GenerateArguments& arguments) {
  write_mesh(arguments.out, mesh);
  if (arguments.quiet) return;
  std::printf("%s: %zu nodes, %zu cells (%s%s), q_mean %.4f\n", arguments.out.c_str(),
              mesh.n_nodes(), mesh.n_cells(), arguments.elements.c_str(),
              arguments.order == 2 ? " of second order" : "", mesh_quality(mesh).q_mean);
}

void list_domains(const char* indent) {
  for (const Domain& domain : domains())
    std::printf("%s%-16s %s (%s)\n", indent, domain.name.c_str(), domain.description.c_str(),
                domain.offers().c_str());
}

void generate(GenerateArguments arguments) {
  if (arguments.domain.empty())
    throw InputError("which domain? 'smoothfem generate --list' shows the available ones");
  if (arguments.out.empty())
    throw InputError("name the mesh to write, for example by '-o " + arguments.domain + ".vtu'");
  if (arguments.domain == "box") {
    if (arguments.distort_to != 0.0)
      throw InputError(
          "--distort-to is for other domains; --displacement moves the nodes of a box");
    arguments.box.out = arguments.out;
    arguments.box.seed = arguments.seed;
    arguments.box.quiet = arguments.quiet;
    return generate_box(arguments.box);
  }
  if (!is_first_process()) return;
  if (!(arguments.distort_to >= 0.0 && arguments.distort_to < 1.0))
    throw InputError("--distort-to is " + std::to_string(arguments.distort_to) +
                     ", but a mean quality lies between 0 (not distorted) and 1");
  const auto output = file_for_standard_output(arguments.out, arguments.to);
  if (output) {
    arguments.out = output->path();
    arguments.quiet = true;  // standard output is the mesh
  }
  require_mesh_path(arguments.out);
  const Domain& domain = find_domain(arguments.domain);
  arguments.elements = domain.elements_named(arguments.elements);
  if (arguments.order == 2) domain.require_second_order();
  const DomainParameters parameters{.elements = arguments.elements,
                                    .edge_scale = arguments.edge_scale,
                                    .seed = arguments.seed,
                                    .algorithm = arguments.algorithm,
                                    .eps = arguments.eps};
  AnyMesh mesh = domain.generate(parameters);
  std::visit([&](auto& of_its_kind) { distort_as_asked(of_its_kind, arguments); }, mesh);
  if (arguments.order == 2) {
    auto [curved, report] = domain.of_second_order(mesh, parameters);
    for (const auto& note : midside_notes(report))
      std::fprintf(stderr, "smoothfem: %s\n", note.sentence.c_str());
    mesh = std::move(curved);
  }
  std::visit([&](const auto& of_its_kind) { write(of_its_kind, arguments); }, mesh);
  if (output) print_content(output->path());
}

}  // namespace

void smoothfem_list_domains(const std::string&) {
  std::printf("DOMAINS (generate NAME, 'domain' in study files)\n\n");
  list_domains("  ");
}

void smoothfem_add_generate_command(CLI::App& app) {
  auto arguments = std::make_shared<GenerateArguments>();
  auto* command = add_subcommand(app, "generate");
  command->add_option("domain", arguments->domain, "domain (see --list)");
  command->add_flag("--list", arguments->list, "only list the domains");
  command->add_option("-o,--out", arguments->out, "mesh to write; - for standard output");
  command->add_option("--to", arguments->to, "format of standard output: msh, vtu, ...");
  command->add_option("--elements", arguments->elements,
                      joined(element_names()) + "; default: the domain's first (see list)");
  command->add_option("--algorithm", arguments->algorithm,
                      "algorithm of the mesh generator, where a domain has several (see list)");
  command
      ->add_option("--order", arguments->order,
                   "1: linear cells (default); 2: cells of second order, with nodes on the true "
                   "boundary, for domains that have it")
      ->check(CLI::IsMember({1, 2}));
  command->add_option("--edge-scale", arguments->edge_scale,
                      "multiply edge lengths by this factor, at least 1 (default: 1)");
  command->add_option("--eps", arguments->eps,
                      "of the domains kershaw and kershaw-cube: above 0, at most 1 (default: 0.3)");
  command->add_option("--distort-to", arguments->distort_to,
                      "distort the mesh to this mean quality (default: not distorted)");
  command
      ->add_option("--distortion", arguments->distortion,
                   "how distortion moves nodes: " + std::string(distortion_kind_names[0]) + " or " +
                       distortion_kind_names[1])
      ->check(CLI::IsMember(
          std::vector<std::string>(distortion_kind_names.begin(), distortion_kind_names.end())));
  command
      ->add_option("--distortion-sweeps", arguments->sweeps,
                   "how often all nodes are moved (default: 1)")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--distortion-least-quality", arguments->min_quality,
                   "lowest mean ratio that distortion may leave (default: 0)")
      ->check(CLI::Range(0.0, 1.0));
  command->add_option("--seed", arguments->seed, "seed of generation and distortion (default: 1)")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--quiet", arguments->quiet, "print nothing but warnings");
  command->add_option(
      "--cells", arguments->box.cells,
      "of the domain box, which is written in pieces (.pvtu): cells along its sides, "
      "for example 100,100,100");
  command
      ->add_option("--split", arguments->box.split,
                   "of the domain box: tetrahedra or triangles (default), or hexahedra or "
                   "quadrilaterals, which are not split")
      ->check(CLI::IsMember({"tetrahedra", "triangles", "hexahedra", "quadrilaterals"}));
  command->add_option(
      "--displacement", arguments->box.displacement,
      "of the domain box: largest displacement of nodes inside, in edges; below 1/6");
  command->add_option("--pieces", arguments->box.n_pieces, "of the domain box: number of files")
      ->check(CLI::Range(1, 9999));
  add_examples(*command,
               {"smoothfem generate gear --elements quadrilaterals --distort-to 0.418 -o gear.msh",
                "smoothfem generate flange --elements hexahedra -o flange.vtu"});
  command->callback([arguments] { arguments->list ? list_domains("") : generate(*arguments); });
}

}  // namespace smoothfem
