// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/cli/smooth_report.h"

#include <cstdio>

#include "meshes/io/atomic_file.h"
#include "meshes/preparation/prepare_mesh.h"

namespace smoothfem {

void Recorder::write_log() const {
  if (!arguments_.log.empty()) write_atomically(arguments_.log, iterations_csv("smooth", rows_));
}

void print_quality(const char* when, const MeshQuality& q) {
  std::printf("%-8s %9.4f %9.4f %9.4f %9zu\n", when, q.q_min, q.q_star_min, q.q_mean, q.n_invalid);
}

void print_stages(const SmoothingResult& result, std::size_t n_free_nodes) {
  for (const auto& stage : result.stages) {
    std::printf("%s stopped after %zu: %s\n", stage.name.c_str(), stage.iterations,
                stage.why_stopped.c_str());
    const bool many = 20 * stage.n_last_reset > n_free_nodes;
    if (many)
      std::printf(
          "  its last iteration reset nodes %zu times (%zu are free), because cells around them "
          "became invalid\n",
          stage.n_last_reset, n_free_nodes);
  }
  if (result.result_record == 0)
    std::printf("the result is the initial mesh: no iteration made a better one\n");
}

void report_midside(const MidsideReport& report, bool quiet) {
  for (const auto& [sentence, is_warning] : midside_notes(report))
    if (is_warning)
      std::fprintf(stderr, "smoothfem: warning: %s\n", sentence.c_str());
    else if (!quiet)
      std::printf("%s\n", sentence.c_str());
}

void report_floor(const std::string& method, const SmoothingResult& result, std::size_t n_cells,
                  bool quiet) {
  const std::string text = floor_text(result);
  if (text.empty()) return;
  if (result.n_floor_invalid > 0)
    std::fprintf(stderr, "smoothfem: warning: %s made %zu of %zu cells invalid; %s\n",
                 method.c_str(), result.n_floor_invalid, n_cells, text.c_str());
  else if (!quiet)
    std::printf("%s\n", text.c_str());
}

void warn_about_invalid_cells(const SmoothArguments& arguments, std::size_t n_invalid,
                              std::size_t n_cells) {
  const std::string text = invalid_cells_text(n_invalid, n_cells);
  if (text.empty()) return;
  if (arguments.fail_if_invalid) {
    const auto advice = text.find(';');
    throw InputError(text.substr(0, advice) + ", so " + arguments.out + " is not written" +
                     text.substr(advice));
  }
  std::fprintf(stderr, "smoothfem: warning: %s, and --fail-if-invalid to make it an error\n",
               text.c_str());
}

}  // namespace smoothfem
