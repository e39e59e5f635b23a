// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/study_plan.h"

#include <algorithm>
#include <cstdio>

#include "studies/framework/results/results_folder.h"
#include "studies/framework/run/progress.h"
#include "studies/framework/run/solve_costs.h"
#include "studies/framework/run/solve_workers.h"
#include "studies/framework/run/study_meshes.h"

namespace smoothfem {

namespace {

/// The number of iterations of a method is not known before it has run.
constexpr int assumed_iterations = 40;

double n_dofs_of(const Topology& topology, int degree) {
  const auto n = static_cast<double>(topology.n_nodes());
  if (degree == 1) return n;
  const auto edges = static_cast<double>(topology.n_edges());
  double inner = 0.0;  // dofs inside faces and cells, of quadrilaterals and hexahedra
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const auto type = topology.cell_type(c);
    if (type == ElementType::quadrilateral) inner += 1.0;
    if (type == ElementType::hexahedron) inner += 1.0 + 3.0;  // a face belongs to two cells
  }
  return n + edges + inner;
}

/// Estimates the bytes of a matrix. A row has about as many entries as a dof has neighbours. The
/// matrix is kept in three layouts.
double matrix_bytes(const Topology& topology, int degree) {
  constexpr double bytes_per_entry = 12.0, n_layouts = 3.0, share_of_own = 0.6;
  double entries = 0.0;
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const double corners = static_cast<double>(topology.cell_nodes(c).size());
    const bool is_simplex = corners == static_cast<double>(topology.dimension()) + 1.0;
    const double dofs = degree == 1    ? corners
                        : is_simplex   ? corners * (corners + 1.0) / 2.0
                        : corners == 4 ? 9.0
                                       : 27.0;
    entries += share_of_own * dofs * dofs;
  }
  return n_layouts * bytes_per_entry * entries;
}

std::string size_text(double bytes) {
  char text[32];
  std::snprintf(text, sizeof(text), bytes < 1e9 ? "%.0f MB" : "%.1f GB",
                bytes < 1e9 ? std::max(1.0, bytes / 1e6) : bytes / 1e9);
  return text;
}

struct Totals {
  double n_solves = 0.0, solve_seconds = 0.0, max_bytes = 0.0, disk_bytes = 0.0;
};

template <int dim, int spacedim>
class Plan {
 public:
  Plan(const Study& study, const StudyOptions& options) : study_(study), options_(options) {}

  void print() {
    std::printf("%s\n\nMeshes\n", study_.header.title.c_str());
    for (std::size_t m = 0; m < study_.meshes.size(); ++m) plan_mesh(m);
    std::printf("\nMethods\n");
    for (const auto& method : study_.methods) {
      std::printf("  %-24s %s", method.name.c_str(), method.type.c_str());
      for (const auto& [key, value] : method.settings)
        std::printf(", %s = %s", key.c_str(), value.c_str());
      std::printf("\n");
    }
    std::printf("\nSmoothing: each method on each mesh, %d time%s for its median time.\n",
                study_.timing_runs, study_.timing_runs == 1 ? "" : "s");
    if (!study_.degrees.empty())
      std::printf(
          "Finite elements: about %.0f solves if each method makes %d iterations, about %s by a "
          "rough estimate.\n",
          totals_.n_solves, assumed_iterations,
          duration_text(totals_.solve_seconds / n_workers()).c_str());
    std::printf("Memory: about %s. Disk: about %s in %s. Nothing has been written.\n",
                size_text(totals_.max_bytes).c_str(), size_text(totals_.disk_bytes).c_str(),
                options_.out.c_str());
  }

 private:
  double n_workers() const { return n_solve_workers(study_, options_); }

  int records_per_method() const {
    return std::max(1, assumed_iterations / study_.record_every.default_interval);
  }

  void plan_mesh(std::size_t m) {
    StudyMesh undistorted = study_.meshes[m];
    undistorted.distort_to_q_mean = undistorted.distort_within = 0.0;
    const auto prepared = prepare_mesh<dim, spacedim>(undistorted, study_, options_.mesh_dir, {});
    const Topology& topology = prepared.mesh.topology();
    const auto n_nodes = static_cast<double>(prepared.n_nodes);
    const auto n_methods = static_cast<double>(study_.methods.size());
    std::printf("  %-24s %zu nodes, %zu cells", undistorted.name.c_str(), prepared.n_nodes,
                prepared.n_cells);
    double bytes = 500.0 * n_nodes + 200.0 * static_cast<double>(prepared.n_cells);
    for (std::size_t d = 0; d < study_.degrees.size(); ++d) {
      const int degree = study_.degrees[d];
      std::printf(", %.0f dofs at degree %d", n_dofs_of(topology, degree), degree);
      bytes = std::max(bytes, matrix_bytes(topology, degree) * (dim == 2 ? n_workers() : 1.0));
      plan_solves(m, d, n_nodes, degree);
    }
    std::printf("%s\n", is_distorted(study_.meshes[m]) ? ", then distorted" : "");
    totals_.max_bytes = std::max(totals_.max_bytes, bytes);
    const double kept = study_.degrees.empty() && !study_.write_series ? 1.0 : records_per_method();
    const double bytes_per_record = 8.0 * (spacedim + static_cast<double>(study_.degrees.size()));
    totals_.disk_bytes += n_methods * n_nodes * (kept * bytes_per_record + 200.0);
  }

  void plan_solves(std::size_t m, std::size_t d, double n_nodes, int degree) {
    const SolveCosts costs;
    const auto seconds = [&](std::size_t method, bool is_result, double times = 1.0) {
      return costs.expected({.mesh = m,
                             .method = method,
                             .degree = d,
                             .is_initial = method == 0,
                             .is_result = is_result,
                             .n_nodes = times * n_nodes,
                             .dimension = dim,
                             .polynomial_degree = degree,
                             .record = 0});
    };
    const bool only_results = study_.only_results_of_seeds && !study_.meshes[m].repeats.empty();
    const double n = static_cast<double>(study_.methods.size()) *
                     (only_results ? 2.0 : static_cast<double>(records_per_method()));
    totals_.n_solves += 1.0 + n;
    totals_.solve_seconds += seconds(0, true) + n * seconds(1, false);
    const double n_further = static_cast<double>(study_.further_solutions.size()) *
                             static_cast<double>(study_.methods.size() + 1);
    totals_.n_solves += n_further;
    totals_.solve_seconds += n_further * seconds(1, true);
    const auto& refined = study_.refined_degrees;
    if (std::find(refined.begin(), refined.end(), degree) == refined.end()) return;
    const auto n_refined = static_cast<double>(study_.methods.size() + 1);
    totals_.n_solves += n_refined;
    totals_.solve_seconds += n_refined * seconds(1, true, 1 << dim);
  }

  const Study& study_;
  const StudyOptions& options_;
  Totals totals_;
};

}  // namespace

void print_plan(const Study& study, const StudyOptions& options) {
  require_writable(options.out);
  require_published_files(study, options.mesh_dir);
  with_dimensions(study.dimensions,
                  [&]<int dim, int spacedim>() { Plan<dim, spacedim>(study, options).print(); });
}

}  // namespace smoothfem
