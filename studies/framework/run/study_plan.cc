// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/study_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "studies/framework/results/results_folder.h"
#include "studies/framework/results/sha256.h"
#include "studies/framework/run/kept/kept_results.h"
#include "studies/framework/run/kept/result_names.h"
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
  Plan(const Study& study, const StudyOptions& options)
      : study_(study),
        options_(options),
        kept_(options.out / kept_folder),
        has_results_(!options.retime && !options.force &&
                     read_provenance(options.out / "provenance.json").status == "complete") {}

  void print() {
    std::printf("%s\n\nMeshes\n", study_.header.title.c_str());
    for (std::size_t m = 0; m < study_.meshes.size(); ++m) plan_mesh(m);
    std::printf("\nMethods\n");
    for (const auto& method : study_.methods) {
      std::printf("  %-24s %s", method.name.c_str(), method.type.c_str());
      for (const auto& [key, value] : method.settings)
        if (!value.empty()) std::printf(", %s = %s", key.c_str(), value.c_str());
      std::printf("\n");
    }
    print_solvers();
    print_kept();
    std::printf("\nSmoothing: %zu of %zu runs are to do%s, each %d time%s for its median time.\n",
                n_open_, study_.meshes.size() * study_.methods.size(),
                n_unknown_ > 0 ? (", and " + std::to_string(n_unknown_) +
                                  " more if code outside of this program has changed")
                                     .c_str()
                               : "",
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

  /// Other solvers' times are not known before they run.
  void print_solvers() const {
    if (study_.solvers.empty()) return;
    std::printf("\nSolvers\n");
    if (!study_.degrees.empty()) std::printf("  %-24s Poisson's equation\n", "poisson");
    for (const auto& solver : study_.solvers) {
      std::printf("  %-24s %s", solver.label.c_str(), solver.type.c_str());
      for (const int degree : solver.degrees) std::printf(", degree %d", degree);
      for (const auto& [key, value] : solver.settings)
        if (!value.empty()) std::printf(", %s = %s", key.c_str(), value.c_str());
      std::printf("; not in the estimate of the time\n");
    }
  }

  /// Reports the methods whose results are kept, for each mesh.
  void print_kept() const {
    if (!std::any_of(kept_methods_.begin(), kept_methods_.end(),
                     [](const auto& methods) { return !methods.empty(); }))
      return;
    std::printf("\nKept from earlier runs\n");
    for (std::size_t m = 0; m < study_.meshes.size(); ++m) {
      std::string names;
      for (const auto& name : kept_methods_[m]) names += (names.empty() ? "" : ", ") + name;
      std::printf("  %-24s %s\n", study_.meshes[m].name.c_str(),
                  names.empty() ? "nothing" : names.c_str());
    }
  }

  /// True if a dry run can have the mesh as smoothing gets it. Distortion may take long, so a mesh
  /// is not distorted here.
  bool is_at_hand(const StudyMesh& mesh) const {
    const bool is_published = !options_.mesh_dir.empty() && !mesh.published_file.empty();
    if (dim < spacedim || is_published || !is_distorted(mesh)) return true;
    const std::string source = mesh.file.empty() ? "" : sha256_of_file(mesh.file);
    return kept_.find_mesh(kept_mesh_name(mesh, source, study_.edge_scale)).has_value();
  }

  /// What an earlier run has left of one mesh.
  struct Known {
    std::string content;                    ///< of the mesh; empty: not known
    std::vector<std::string> trajectories;  ///< by method, Trajectory::content; empty: to be made
  };

  Known known_of(const PreparedMesh<dim, spacedim>& prepared) const {
    Known known{.content = mesh_content(prepared.mesh, prepared),
                .trajectories = std::vector<std::string>(study_.methods.size())};
    for (std::size_t k = 0; k < study_.methods.size(); ++k) {
      const StudyMethod& method = study_.methods[k];
      if (is_of_other_code(method) || options_.retime) continue;
      const auto trajectory = kept_.load_trajectory(trajectory_name(
          known.content, method, study_, is_of_results_only(study_, prepared.description),
          options_.threads_of(method)));
      if (trajectory && trajectory->failure.empty()) known.trajectories[k] = trajectory->content;
    }
    return known;
  }

  /// True if the records of a method (its index plus one; 0: the initial mesh) are to be solved.
  bool is_open(const Known& known, const PreparedMesh<dim, spacedim>& prepared, std::size_t method,
               int degree, bool is_refined, std::size_t solution) const {
    if (known.content.empty()) return true;
    if (method > 0 && known.trajectories[method - 1].empty()) return true;
    return !kept_.has_solved(
        solved_name({.mesh_content = known.content,
                     .trajectory = method == 0 ? "" : known.trajectories[method - 1],
                     .degree = degree,
                     .is_refined = is_refined,
                     .is_further = solution > 0,
                     .ties = prepared.ties.get()},
                    *solutions_of(study_)[solution], study_));
  }

  int records_per_method() const {
    const auto& every = study_.record_every;
    const int n = std::max(1, assumed_iterations / every.default_interval);
    constexpr int n_even = RecordEvery::n_before_growth;
    if (every.growth == 1.0 || n <= n_even) return n;
    return n_even +
           static_cast<int>(std::log(static_cast<double>(n) / n_even) / std::log(every.growth));
  }

  void plan_mesh(std::size_t m) {
    StudyMesh mesh = study_.meshes[m];
    const bool is_here = !options_.force && is_at_hand(mesh);
    if (!is_here) mesh.distort_to_q_mean = mesh.distort_within = 0.0;
    const auto prepared =
        prepare_mesh<dim, spacedim>(mesh, study_, options_.mesh_dir, is_here ? &kept_ : nullptr);
    const Known known = is_here ? known_of(prepared) : Known{};
    note_kept(known);
    const Topology& topology = prepared.mesh.topology();
    const auto n_nodes = static_cast<double>(prepared.n_nodes);
    const auto n_methods = static_cast<double>(study_.methods.size());
    std::printf("  %-24s %zu nodes, %zu cells", mesh.name.c_str(), prepared.n_nodes,
                prepared.n_cells);
    double bytes = 500.0 * n_nodes + 200.0 * static_cast<double>(prepared.n_cells);
    for (std::size_t d = 0; d < study_.degrees.size(); ++d) {
      const int degree = study_.degrees[d];
      std::printf(", %.0f dofs at degree %d", n_dofs_of(topology, degree), degree);
      bytes = std::max(bytes, matrix_bytes(topology, degree) * (dim == 2 ? n_workers() : 1.0));
      plan_solves(m, d, prepared, known);
    }
    std::printf("%s\n", is_distorted(study_.meshes[m]) ? ", then distorted" : "");
    totals_.max_bytes = std::max(totals_.max_bytes, bytes);
    const double kept = keeps_all_records(study_) ? records_per_method() : 1.0;
    const double bytes_per_record = 8.0 * (spacedim + static_cast<double>(study_.degrees.size()));
    totals_.disk_bytes += n_methods * n_nodes * (kept * bytes_per_record + 200.0);
  }

  void note_kept(const Known& known) {
    auto& names = kept_methods_.emplace_back();
    for (std::size_t k = 0; k < study_.methods.size(); ++k) {
      const bool is_kept = !known.content.empty() && !known.trajectories[k].empty();
      if (is_kept)
        names.push_back(study_.methods[k].name);
      else if (has_results_ && is_of_other_code(study_.methods[k]))
        ++n_unknown_;
      else
        ++n_open_;
    }
  }

  /// True if looking at the method's code would run it.
  static bool is_of_other_code(const StudyMethod& method) {
    return method.is_stand_in || method.type == "command";
  }

  void plan_solves(std::size_t m, std::size_t d, const PreparedMesh<dim, spacedim>& prepared,
                   const Known& known) {
    const int degree = study_.degrees[d];
    const auto n_nodes = static_cast<double>(prepared.n_nodes);
    const SolveCosts costs;
    const auto add = [&](std::size_t method, bool is_result, double n, double times = 1.0) {
      totals_.n_solves += n;
      totals_.solve_seconds += n * costs.expected({.mesh = m,
                                                   .method = method,
                                                   .degree = d,
                                                   .is_initial = method == 0,
                                                   .is_result = is_result,
                                                   .n_nodes = times * n_nodes,
                                                   .dimension = dim,
                                                   .polynomial_degree = degree,
                                                   .record = 0});
    };
    const double n_records =
        is_of_results_only(study_, study_.meshes[m]) || !is_recorded(study_, degree)
            ? 2.0
            : records_per_method();
    const auto& refined = study_.refined_degrees;
    const bool refines = std::find(refined.begin(), refined.end(), degree) != refined.end();
    for (std::size_t k = 0; k <= study_.methods.size(); ++k) {
      if (is_open(known, prepared, k, degree, false, 0)) add(k, k == 0, k == 0 ? 1.0 : n_records);
      for (std::size_t s = 1; s <= study_.further_solutions.size(); ++s)
        if (is_open(known, prepared, k, degree, false, s)) add(1, true, 1.0);
      if (refines && is_open(known, prepared, k, degree, true, 0)) add(1, true, 1.0, 1 << dim);
    }
  }

  const Study& study_;
  const StudyOptions& options_;
  const KeptResults kept_;
  std::vector<std::vector<std::string>> kept_methods_;  ///< of each mesh
  std::size_t n_open_ = 0;                              ///< smoothing runs to do
  std::size_t n_unknown_ = 0;  ///< runs to do if code has changed that a dry run does not run
  bool has_results_ = false;   ///< complete ones of an earlier run
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
