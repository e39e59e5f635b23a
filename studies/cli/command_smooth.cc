#include <cstdio>
#include <memory>
#include <optional>

#include "meshes/io/atomic_file.h"
#include "meshes/io/mesh_file.h"
#include "meshes/io/vtu_series.h"
#include "smoothing/loop/smooth.h"
#include "studies/cli/commands.h"
#include "studies/framework/results.h"

namespace smoothfem {

namespace {

struct Arguments {
  std::string in, out, method, log, series;
  std::vector<std::string> settings;
  bool quiet = false;
};

template <int dim>
void apply_settings(Method<dim>& method, const std::vector<std::string>& settings) {
  for (const auto& setting : settings) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos)
      throw InputError("--set needs key=value, but is given as '" + setting + "'");
    method.set(setting.substr(0, equals), setting.substr(equals + 1));
  }
}

void print_row(const char* when, const MeshQuality& q) {
  std::printf("%-8s %9.4f %9.4f %9.4f %9zu\n", when, q.q_min, q.q_star_min, q.q_mean, q.n_invalid);
}

/// What the observer keeps: rows for the log, and meshes for the series as they come.
class Recorder {
 public:
  explicit Recorder(const Arguments& arguments) : arguments_(arguments) {
    if (!arguments.series.empty()) series_.emplace(arguments.series);
  }

  template <int dim>
  void observe(const IterationRecord& record, const Mesh<dim>& mesh) {
    rows_.push_back({.mesh = std::filesystem::path(arguments_.in).stem().string(),
                     .method = arguments_.method,
                     .iteration = record,
                     .degree = 0,
                     .solved = {},
                     .status = record.quality.n_invalid > 0 ? "invalid mesh" : "not solved"});
    if (!series_) return;
    MeshFields fields;
    fields.cell["mean_ratio"] = cell_mean_ratios(mesh);
    series_->add(static_cast<double>(record.record), mesh, fields);
  }
  void write_log() const {
    if (!arguments_.log.empty()) write_atomically(arguments_.log, iterations_csv("smooth", rows_));
  }

 private:
  const Arguments& arguments_;
  std::optional<VtuSeries> series_;
  std::vector<IterationRow> rows_;
};

template <int dim>
void smooth_mesh(const Arguments& arguments, Mesh<dim>& mesh,
                 const std::vector<std::size_t>& cell_lines) {
  Method<dim> method = make_method<dim>(arguments.method);
  apply_settings(method, arguments.settings);
  for (const auto& stage : method.stages)
    if (stage->rule().needs_valid_mesh) require_valid(mesh, arguments.in, cell_lines);

  const MeshQuality before = mesh_quality(mesh);
  Recorder recorder(arguments);
  const auto result = smooth(
      mesh, method, [&](const auto& record, const auto& now) { recorder.observe(record, now); });
  MeshFields fields;
  fields.cell["mean_ratio"] = cell_mean_ratios(mesh);
  write_mesh(arguments.out, mesh, fields);
  recorder.write_log();
  if (arguments.quiet) return;
  std::printf("%-8s %9s %9s %9s %9s\n", "", "q_min", "q*_min", "q_mean", "invalid");
  print_row("before", before);
  print_row("after", result.quality);
  std::printf("%s: %s iterations in %.4g s; written to %s\n", method.info.title.c_str(),
              result.iterations_text().c_str(), result.smoothing_seconds, arguments.out.c_str());
}

void smooth_file(const Arguments& arguments) {
  MeshFile file = read_mesh(arguments.in);
  std::visit([&](auto& mesh) { smooth_mesh(arguments, mesh, file.cell_lines); }, file.mesh);
}

}  // namespace

void add_smooth_command(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  auto* command = app.add_subcommand("smooth", "smooth a mesh file");
  command->add_option("in", arguments->in, "mesh to read")->required();
  command->add_option("-m,--method", arguments->method, "method (see 'list')")->required();
  command->add_option("-o,--out", arguments->out, "mesh to write")->required();
  command->add_option("--set", arguments->settings, "parameter of the method: key=value")
      ->allow_extra_args(false);
  command->add_option("--log", arguments->log, "CSV file with one row an iteration");
  command->add_option("--series", arguments->series, "VTU series (.pvd) with every iteration");
  command->add_flag("--quiet", arguments->quiet, "print nothing");
  command->callback([arguments] { smooth_file(*arguments); });
}

}  // namespace smoothfem
