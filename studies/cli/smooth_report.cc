// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/cli/smooth_report.h"

#include <cstdio>

#include "meshes/io/atomic_file.h"

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

void report_floor(const std::string& method, const SmoothingResult& result, std::size_t n_cells,
                  bool quiet) {
  if (result.n_floor_reset == 0) return;
  const char* rule =
      "nodes are back at their initial positions, so that no cell is worse than the worst one "
      "before "
      "(--allow-worse leaves them)";
  if (result.n_floor_invalid > 0)
    std::fprintf(stderr, "smoothfem: warning: %s made %zu of %zu cells invalid; %zu %s\n",
                 method.c_str(), result.n_floor_invalid, n_cells, result.n_floor_reset, rule);
  else if (!quiet)
    std::printf("%zu %s\n", result.n_floor_reset, rule);
}

void warn_about_invalid_cells(const SmoothArguments& arguments, std::size_t n_invalid,
                              std::size_t n_cells) {
  if (n_invalid == 0) return;
  const std::string what = std::to_string(n_invalid) + " of " + std::to_string(n_cells) +
                           " cells of the smoothed mesh are invalid";
  const std::string method =
      "choose a method that keeps cells valid, for example smart-laplace or getme";
  if (arguments.fail_if_invalid)
    throw InputError(what + ", so " + arguments.out + " is not written; " + method);
  std::fprintf(stderr, "smoothfem: warning: %s; %s, and --fail-if-invalid to make it an error\n",
               what.c_str(), method.c_str());
}

}  // namespace smoothfem
