#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "meshes/io/mesh_file.h"
#include "smoothing/quality/mesh_quality.h"
#include "studies/cli/commands.h"

namespace smoothfem {

namespace {

constexpr std::size_t n_bins = 10;

struct Arguments {
  std::string in;
  bool json = false;
};

std::map<std::string, std::size_t> count_types(const Topology& topology) {
  std::map<std::string, std::size_t> counts;
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const ElementType type = topology.cell_type(c);
    ++counts[type == ElementType::polygon ? std::to_string(topology.cell_nodes(c).size()) + "-gon"
                                          : std::string(name_of(type))];
  }
  return counts;
}

template <int dim>
void print_text(const Mesh<dim>& mesh, const MeshQuality& q,
                const std::vector<std::size_t>& histogram) {
  const Topology& topology = mesh.topology();
  std::printf("nodes      %zu (%zu fixed)\n", mesh.n_nodes(),
              mesh.n_nodes() - topology.free_nodes().size());
  std::string types;
  for (const auto& [type, count] : count_types(topology))
    types +=
        (types.empty() ? "" : ", ") + std::to_string(count) + " " + type + (count == 1 ? "" : "s");
  std::printf("cells      %zu (%s)\n", mesh.n_cells(), types.c_str());
  std::printf("q_min      %.6f\nq*_min     %.6f\nq_mean     %.6f\ninvalid    %zu\n", q.q_min,
              q.q_star_min, q.q_mean, q.n_invalid);
  const std::size_t most = *std::max_element(histogram.begin(), histogram.end());
  constexpr std::size_t width = 50;
  std::printf("mean ratio\n");
  for (std::size_t b = 0; b < n_bins; ++b)
    std::printf("  %.1f-%.1f %8zu %s\n", static_cast<double>(b) / n_bins,
                static_cast<double>(b + 1) / n_bins, histogram[b],
                std::string((histogram[b] * width + most - 1) / most, '#').c_str());
}

template <int dim>
void print_json(const Mesh<dim>& mesh, const MeshQuality& q,
                const std::vector<std::size_t>& histogram) {
  nlohmann::ordered_json json;
  json["n_nodes"] = mesh.n_nodes();
  json["n_fixed_nodes"] = mesh.n_nodes() - mesh.topology().free_nodes().size();
  json["n_cells"] = mesh.n_cells();
  json["cells"] = count_types(mesh.topology());
  json["n_invalid"] = q.n_invalid;
  json["q_min"] = q.q_min;
  json["q_star_min"] = q.q_star_min;
  json["q_mean"] = q.q_mean;
  json["histogram"] = histogram;
  std::printf("%s\n", json.dump(2).c_str());
}

template <int dim>
void report(const Arguments& arguments, const Mesh<dim>& mesh,
            const std::vector<std::size_t>& cell_lines) {
  const auto cell_quality = cell_mean_ratios(mesh);
  const MeshQuality quality = mesh_quality(mesh.topology(), cell_quality);
  const auto histogram = quality_histogram(cell_quality, n_bins);
  (arguments.json ? print_json<dim> : print_text<dim>)(mesh, quality, histogram);
  std::fflush(stdout);
  require_valid(mesh, arguments.in, cell_lines);
}

void report_quality(const Arguments& arguments) {
  const MeshFile file = read_mesh(arguments.in);
  std::visit([&](const auto& mesh) { report(arguments, mesh, file.cell_lines); }, file.mesh);
}

}  // namespace

void add_quality_command(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  auto* command = app.add_subcommand(
      "quality", "quality numbers of a mesh file; exit code 2 if it has invalid cells");
  command->add_option("in", arguments->in, "mesh to read")->required();
  command->add_flag("--json", arguments->json, "as JSON");
  command->callback([arguments] { report_quality(*arguments); });
}

}  // namespace smoothfem
