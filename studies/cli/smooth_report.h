// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "meshes/io/vtu_series.h"
#include "smoothing/loop/smooth.h"
#include "studies/cli/smooth_arguments.h"
#include "studies/framework/results/results.h"

namespace smoothfem {

/// An observer that keeps rows for the log and writes meshes of the series immediately.
class Recorder {
 public:
  explicit Recorder(const SmoothArguments& arguments) : arguments_(arguments) {
    if (!arguments.series.empty()) series_.emplace(arguments.series);
  }

  template <int dim, int spacedim>
  void observe(const IterationRecord& record, const Mesh<dim, spacedim>& mesh) {
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
  bool records() const { return series_ || !arguments_.log.empty(); }
  void write_log() const;

 private:
  const SmoothArguments& arguments_;
  std::optional<VtuSeries> series_;
  std::vector<IterationRow> rows_;
};

/// Prints a line of the table of qualities.
void print_quality(const char* when, const MeshQuality& quality);

/// Prints why each stage ended, and a hint if its last iteration reset many nodes.
void print_stages(const SmoothingResult& result, std::size_t n_free_nodes);

/// Says what became of midside nodes; warns if the boundary has changed.
void report_midside(const MidsideReport& report, bool quiet);

/// Says how many nodes Method::floor has reset, and warns if the method had made cells invalid.
void report_floor(const std::string& method, const SmoothingResult& result, std::size_t n_cells,
                  bool quiet);

/// Warns if a method without quality control has left invalid cells. With --fail-if-invalid it
/// throws InputError instead.
void warn_about_invalid_cells(const SmoothArguments& arguments, std::size_t n_invalid,
                              std::size_t n_cells);

}  // namespace smoothfem
