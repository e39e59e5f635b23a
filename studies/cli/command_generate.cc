#include <cstdio>
#include <memory>

#include "meshes/distortion/distort.h"
#include "meshes/generators/domains.h"
#include "meshes/io/mesh_file.h"
#include "smoothing/quality/mesh_quality.h"
#include "studies/cli/commands.h"

namespace smoothfem {

namespace {

struct Arguments {
  std::string domain, out, elements = "triangles";
  double edge_scale = 1.0, distort_to = 0.0;
  std::uint64_t seed = 1;
};

void generate(const Arguments& arguments) {
  if (!(arguments.distort_to >= 0.0 && arguments.distort_to < 1.0))
    throw InputError("--distort-to is " + std::to_string(arguments.distort_to) +
                     ", but a mean quality lies between 0 (not distorted) and 1");
  PlanarMesh mesh =
      find_domain(arguments.domain)
          .generate({.element_type = arguments.elements == "triangles" ? ElementType::triangle
                                                                       : ElementType::quadrilateral,
                     .edge_scale = arguments.edge_scale,
                     .seed = arguments.seed});
  if (arguments.distort_to > 0.0) {
    DistortionParameters parameters;
    parameters.target_q_mean = arguments.distort_to;
    parameters.seed = arguments.seed;
    distort(mesh, parameters);
  }
  write_mesh(arguments.out, mesh);
  std::printf("%s: %zu nodes, %zu %s, q_mean %.4f\n", arguments.out.c_str(), mesh.n_nodes(),
              mesh.n_cells(), arguments.elements.c_str(), mesh_quality(mesh).q_mean);
}

}  // namespace

void add_generate_command(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  auto* command = app.add_subcommand("generate", "generate and distort the mesh of a domain");
  command->add_option("domain", arguments->domain, "domain (see 'list')")->required();
  command->add_option("-o,--out", arguments->out, "mesh to write")->required();
  command->add_option("--elements", arguments->elements, "triangles or quadrilaterals")
      ->check(CLI::IsMember({"triangles", "quadrilaterals"}));
  command->add_option("--edge-scale", arguments->edge_scale, "edges longer by this factor");
  command->add_option("--distort-to", arguments->distort_to, "mean quality to distort to");
  command->add_option("--seed", arguments->seed, "seed of generation and distortion")
      ->check(CLI::NonNegativeNumber);
  command->callback([arguments] { generate(*arguments); });
}

}  // namespace smoothfem
