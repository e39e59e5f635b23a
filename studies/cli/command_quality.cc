// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "meshes/doctor/examine_boundary.h"
#include "meshes/io/atomic_file.h"
#include "meshes/io/mesh_file.h"
#include "meshes/metrics/metric_statistics.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/quality/dihedral_angles.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/quality/warpage.h"
#include "smoothing/second_order/curved_quality.h"
#include "smoothing/surface/surface_constraints.h"
#include "studies/cli/commands.h"
#include "studies/cli/mesh_notes.h"
#include "studies/cli/piece_commands.h"
#include "studies/cli/plots.h"
#include "studies/cli/smooth_notes.h"
#include "studies/cli/standard_streams.h"
#include "studies/framework/results/csv_text.h"

namespace smoothfem {

namespace {

constexpr std::size_t n_bins = 10;
constexpr std::size_t n_csv_bins = 40;  ///< a picture shows more than lines of text

struct QualityArguments {
  std::string in, from, histogram, mark, metrics;
  double below = 0.0;
  bool json = false, keep_orientation = false;
};

std::string plural(const std::string& type) {
  if (type.ends_with("hedron")) return type.substr(0, type.size() - 2) + "a";
  return type + "s";
}

std::map<std::string, std::size_t> count_types(const Topology& topology) {
  std::map<std::string, std::size_t> counts;
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const ElementType type = topology.cell_type(c);
    ++counts[type == ElementType::polygon ? std::to_string(topology.cell_nodes(c).size()) + "-gon"
                                          : std::string(name_of(type))];
  }
  return counts;
}

/// Numbers with the names that they have in JSON, and as text.
struct NamedNumber {
  const char *key, *text;
  double value;
};

std::vector<NamedNumber> geometry_numbers(const PlanarMesh& mesh) {
  const AngleRange angles = angle_range(mesh);
  return {{"angle_min", "angle_min", angles.min}, {"angle_max", "angle_max", angles.max}};
}
std::vector<NamedNumber> geometry_numbers(const VolumeMesh& mesh) {
  const MeshWarpage warpage = mesh_warpage(mesh);
  const AngleRange angles = angle_range(mesh);
  return {{"warpage_max", "w_max", warpage.max},
          {"warpage_mean", "w_mean", warpage.mean},
          {"dihedral_min", "dihedral_min", angles.min},
          {"dihedral_max", "dihedral_max", angles.max}};
}
/// Counts nodes that cannot move, and nodes that move on feature lines only.
std::vector<NamedNumber> geometry_numbers(const SurfaceMesh& mesh) {
  const auto count = [&](GeometricClassification::Kind kind) {
    const auto& carriers = mesh.constraints()->classifications();
    return static_cast<double>(std::count_if(carriers.begin(), carriers.end(),
                                             [&](const auto& c) { return c.kind == kind; }));
  };
  return {{"n_corners", "corners", count(GeometricClassification::corner)},
          {"n_line_nodes", "on lines", count(GeometricClassification::line)}};
}

/// Adds the numbers of curved cells; the least scaled Jacobian is a lower bound.
template <int dim>
void add_curved_numbers(const Mesh<dim>& mesh, std::vector<NamedNumber>& numbers) {
  const auto scaled = scaled_jacobians(mesh);
  const auto sizes = curved_cell_sizes(mesh);
  const auto sum = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
  };
  numbers.push_back(
      {"scaled_jacobian_min", "sj_min", *std::min_element(scaled.begin(), scaled.end())});
  numbers.push_back(
      {"scaled_jacobian_mean", "sj_mean", sum(scaled) / static_cast<double>(scaled.size())});
  numbers.push_back({dim == 2 ? "area" : "volume", dim == 2 ? "area" : "volume", sum(sizes)});
}
void add_curved_numbers(const SurfaceMesh&, std::vector<NamedNumber>&) {}

/// Everything that is reported about a mesh.
struct Report {
  std::size_t n_nodes, n_midside_nodes, n_fixed_nodes, n_cells;
  std::string fixed;  ///< why the fixed nodes stay
  std::map<std::string, std::size_t> fixed_by_reason;
  std::map<std::string, std::size_t> cells;
  MeshQuality quality;
  std::vector<NamedNumber> geometry;
  std::vector<std::size_t> histogram;
  std::vector<MetricStatistics> metrics;
  std::vector<Finding> findings;
};

void print_text(const Report& r) {
  std::string types;
  for (const auto& [type, count] : r.cells)
    types += (types.empty() ? "" : ", ") + std::to_string(count) + " " +
             (count == 1 ? type : plural(type));
  std::printf("%-13s%zu (%zu fixed)\n", "nodes", r.n_nodes, r.n_fixed_nodes);
  if (r.n_midside_nodes > 0)
    std::printf("%-13s%zu follow their corners\n", "midside", r.n_midside_nodes);
  if (!r.fixed.empty()) std::printf("%-13s%s\n", "", r.fixed.c_str());
  std::printf("%-13s%zu (%s)\n", "cells", r.n_cells, types.c_str());
  std::printf("%-13s%.6f\n%-13s%.6f\n%-13s%.6f\n%-13s%zu\n", "q_min", r.quality.q_min, "q*_min",
              r.quality.q_star_min, "q_mean", r.quality.q_mean, "invalid", r.quality.n_invalid);
  for (const auto& [key, text, value] : r.geometry) std::printf("%-13s%.6g\n", text, value);
  for (const Finding& finding : r.findings)
    std::printf("%-13s%s\n", "warning", finding.sentence.c_str());
  const std::size_t most = *std::max_element(r.histogram.begin(), r.histogram.end());
  constexpr std::size_t width = 50;
  std::printf("mean ratio\n");
  for (std::size_t b = 0; b < n_bins; ++b)
    std::printf("  %.1f-%.1f %8zu %s\n", static_cast<double>(b) / n_bins,
                static_cast<double>(b + 1) / n_bins, r.histogram[b],
                std::string((r.histogram[b] * width + most - 1) / most, '#').c_str());
  if (r.metrics.empty()) return;
  std::printf("%-22s%8s%11s%11s%11s%11s%11s%11s\n", "metric", "cells", "min", "p05", "median",
              "mean", "p95", "max");
  for (const MetricStatistics& m : r.metrics) {
    std::printf("%-22s%8zu", m.metric.c_str(), m.n_cells);
    for (const double value : {m.min, m.p05, m.median, m.mean, m.p95, m.max})
      m.n_cells > 0 ? std::printf("%11.4g", value) : std::printf("%11s", "-");
    std::printf("\n");
  }
}

void print_json(const Report& r) {
  nlohmann::ordered_json json = {{"n_nodes", r.n_nodes},
                                 {"n_fixed_nodes", r.n_fixed_nodes},
                                 {"fixed_nodes", r.fixed_by_reason},
                                 {"n_cells", r.n_cells},
                                 {"cells", r.cells},
                                 {"n_invalid", r.quality.n_invalid},
                                 {"q_min", r.quality.q_min},
                                 {"q_star_min", r.quality.q_star_min},
                                 {"q_mean", r.quality.q_mean}};
  if (r.n_midside_nodes > 0) json["n_midside_nodes"] = r.n_midside_nodes;
  for (const auto& [key, text, value] : r.geometry) json[key] = value;
  json["histogram"] = r.histogram;
  for (const MetricStatistics& m : r.metrics) {
    auto& of_metric = json["metrics"][m.metric];
    of_metric["n_cells"] = m.n_cells;
    if (m.n_cells == 0) continue;
    for (const auto& [key, value] :
         std::initializer_list<std::pair<const char*, double>>{{"min", m.min},
                                                               {"p05", m.p05},
                                                               {"median", m.median},
                                                               {"mean", m.mean},
                                                               {"p95", m.p95},
                                                               {"max", m.max}})
      of_metric[key] = value;
  }
  json["findings"] = nlohmann::ordered_json::array();
  for (const Finding& finding : r.findings) json["findings"].push_back(json_of(finding));
  std::printf("%s\n", json.dump(2, ' ', false, decltype(json)::error_handler_t::replace).c_str());
}

/// Numbers of cells of each type by mean ratio, for `plots histogram`.
std::string histogram_csv(const Topology& topology, const std::vector<double>& cell_quality) {
  std::map<std::string, std::vector<double>> by_type;
  for (CellIndex c = 0; c < topology.n_cells(); ++c)
    by_type[std::string(name_of(topology.cell_type(c)))].push_back(cell_quality[c]);
  CsvText csv("lower,upper,count,cell_type");
  for (const auto& [type, of_type] : by_type) {
    const auto counts = quality_histogram(of_type, n_csv_bins);
    for (std::size_t b = 0; b < n_csv_bins; ++b) {
      csv.number(static_cast<double>(b) / n_csv_bins);
      csv.number(static_cast<double>(b + 1) / n_csv_bins);
      csv.integer(counts[b]).field(type).end_line();
    }
  }
  return csv.text();
}

std::map<std::string, std::size_t> fixed_by_reason(const Topology& topology) {
  std::map<std::string, std::size_t> counts;
  const auto by_reason = count_fixed_reasons(topology);
  for (std::size_t r = 0; r < by_reason.size(); ++r)
    if (by_reason[r] > 0) counts[std::string(fixed_reasons[r].name)] = by_reason[r];
  return counts;
}

/// Cells that are invalid or whose mean ratio is below the bound, the worst first.
std::vector<CellIndex> bad_cells(const std::vector<double>& cell_quality, double below) {
  std::vector<CellIndex> cells;
  for (CellIndex c = 0; c < cell_quality.size(); ++c)
    if (!(cell_quality[c] > 0.0) || cell_quality[c] < below) cells.push_back(c);
  std::stable_sort(cells.begin(), cells.end(),
                   [&](CellIndex a, CellIndex b) { return cell_quality[a] < cell_quality[b]; });
  return cells;
}

/// Writes the mesh with its bad cells marked, and lists the worst of them.
template <int dim, int spacedim>
void mark_bad_cells(const QualityArguments& arguments, const Mesh<dim, spacedim>& mesh,
                    const std::vector<double>& cell_quality) {
  constexpr std::size_t n_listed = 10;
  const auto bad = bad_cells(cell_quality, arguments.below);
  MeshFields fields;
  fields.cell["mean_ratio"] = cell_quality;
  auto& marks = fields.cell["bad"];
  marks.assign(mesh.n_cells(), 0.0);
  for (const CellIndex c : bad) marks[c] = 1.0;
  write_mesh(arguments.mark, mesh, fields);
  if (arguments.json) return;
  std::printf("%zu cells are invalid or below %g; marked by the cell field 'bad' in %s\n",
              bad.size(), arguments.below, arguments.mark.c_str());
  for (std::size_t i = 0; i < std::min(n_listed, bad.size()); ++i) {
    const CellIndex c = bad[i];
    std::printf("  cell %zu  mean ratio %.4g  at", mesh.topology().labels().cell_number(c),
                cell_quality[c]);
    const auto nodes = mesh.topology().cell_nodes(c);
    Point<spacedim> centre = Point<spacedim>::Zero();
    for (const NodeIndex node : nodes)
      centre += mesh.coordinates()[node] / static_cast<double>(nodes.size());
    for (const double coordinate : centre) std::printf(" %.6g", coordinate);
    std::printf("\n");
  }
  if (bad.size() > n_listed) std::printf("  ...\n");
}

bool is_picture(const std::filesystem::path& path) {
  return path.extension() == ".png" || path.extension() == ".pdf" || path.extension() == ".svg";
}

void require_histogram_path(const std::filesystem::path& path) {
  if (path.extension() != ".csv" && !is_picture(path))
    throw InputError("the histogram " + path.string() +
                     " must end with .csv, or, to be drawn, with .png, .pdf or .svg");
}

/// Writes the counts as CSV, or draws them by the Python package under the name of the mesh.
void write_histogram(const std::filesystem::path& path, const std::filesystem::path& mesh,
                     const std::string& counts) {
  if (!is_picture(path)) return write_atomically(path, counts);
  const ScratchFolder folder;
  const auto csv = folder.path() / mesh.filename();
  write_atomically(csv, counts);
  if (std::system(plots_command({"histogram", csv.string(), path.string()}).c_str()) != 0)
    throw InputError("the histogram " + path.string() + " cannot be drawn, for the reason above");
}

template <int dim, int spacedim>
void report(const QualityArguments& arguments, const Mesh<dim, spacedim>& mesh,
            const std::vector<std::size_t>& cell_lines) {
  const Topology& topology = mesh.topology();
  const auto cell_quality = cell_mean_ratios(mesh);
  auto geometry = geometry_numbers(mesh);
  if (topology.midside()) add_curved_numbers(mesh, geometry);
  (arguments.json ? print_json : print_text)(
      {.n_nodes = mesh.n_nodes(),
       .n_midside_nodes = n_midside_nodes(topology),
       .n_fixed_nodes = n_fixed_nodes(topology),
       .n_cells = mesh.n_cells(),
       .fixed = fixed_reasons_text(topology),
       .fixed_by_reason = fixed_by_reason(topology),
       .cells = count_types(topology),
       .quality = mesh_quality(topology, cell_quality),
       .geometry = std::move(geometry),
       .histogram = quality_histogram(cell_quality, n_bins),
       .metrics = metric_statistics(metrics_named(arguments.metrics), &mesh),
       .findings = examine_boundary(mesh).findings});
  if (!arguments.mark.empty()) mark_bad_cells(arguments, mesh, cell_quality);
  std::fflush(stdout);
  if (!arguments.histogram.empty())
    write_histogram(arguments.histogram, arguments.in, histogram_csv(topology, cell_quality));
  require_valid(mesh, arguments.in, cell_lines);
}

void report_quality(QualityArguments arguments) {
  if (works_in_parts("")) {
    if (!arguments.histogram.empty() || !arguments.mark.empty() || !arguments.metrics.empty() ||
        arguments.below > 0.0 || !arguments.from.empty())
      throw InputError(
          "--histogram, --mark, --below, --metrics and --from do not work on a mesh in parts; "
          "leave them out, or use one file without mpirun");
    return report_pieces(arguments.in, arguments.json);
  }
  if (!arguments.histogram.empty()) require_histogram_path(arguments.histogram);
  if (!(arguments.below >= 0.0 && arguments.below <= 1.0))
    throw InputError("--below is " + std::to_string(arguments.below) +
                     ", but a mean ratio lies between 0 and 1");
  if (arguments.mark.empty() && arguments.below > 0.0)
    throw InputError("--below needs --mark FILE, which writes the marked mesh");
  if (!arguments.mark.empty()) require_mesh_path(arguments.mark);
  (void)metrics_named(arguments.metrics);  // throws before a large mesh is read
  const auto input = copy_of_standard_input(arguments.in, arguments.from);
  if (input) arguments.in = input->path();
  const MeshFile file = read_mesh(arguments.in, {.turns_over = !arguments.keep_orientation});
  print_notes(arguments.in, file.notes);
  std::visit([&](const auto& mesh) { report(arguments, mesh, file.cell_lines); }, file.mesh);
}

}  // namespace

void add_quality_command(CLI::App& app) {
  auto arguments = std::make_shared<QualityArguments>();
  auto* command = add_subcommand(app, "quality");
  command->add_option("in", arguments->in, "mesh to read; - for standard input")->required();
  command->add_option("--from", arguments->from, "format of standard input: msh, vtu, ...");
  command->add_option(
      "--histogram", arguments->histogram,
      "numbers of cells by mean ratio and type: .csv, or drawn as .png, .pdf or .svg");
  command->add_option("--mark", arguments->mark,
                      "write the mesh to this file with its bad cells marked (cell field 'bad'), "
                      "and list the worst");
  command->add_option(
      "--below", arguments->below,
      "bad cells are invalid cells and cells with a lower mean ratio than this (default: 0)");
  command
      ->add_option(
          "--metrics", arguments->metrics,
          "also other metrics: range, mean and percentiles over the cells; names separated by "
          "commas, or all")
      ->expected(0, 1)
      ->default_str("all");
  add_keep_orientation(*command, arguments->keep_orientation);
  command->add_flag("--json", arguments->json, "as JSON");
  add_examples(*command,
               {"smoothfem quality in.vtu", "smoothfem quality in.vtu --mark bad.vtu --below 0.2",
                "smoothfem quality in.vtu --metrics shape,size_gradation"});
  command->callback([arguments] { report_quality(*arguments); });
}

}  // namespace smoothfem
