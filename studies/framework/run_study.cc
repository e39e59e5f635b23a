#include "studies/framework/run_study.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <list>

#include "meshes/io/atomic_file.h"
#include "meshes/io/mesh_file.h"
#include "meshes/io/vtu_series.h"
#include "studies/framework/progress.h"
#include "studies/framework/provenance.h"
#include "studies/framework/results.h"
#include "studies/framework/solve_queue.h"
#include "studies/framework/study_meshes.h"
#include "studies/framework/trajectory.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;

/// The finite element tasks of one mesh: those of the initial mesh, shared by all methods, and
/// those of each method's snapshots; one a degree in each list.
struct MeshTasks {
  std::vector<SolveTask*> initial;
  std::vector<std::vector<std::vector<SolveTask*>>> methods;  ///< [method][snapshot][degree]
};

/// Before hours of work, and without leaving a trace: can files be written below this folder?
void require_writable(const fs::path& folder) {
  fs::path existing = fs::absolute(folder);
  while (!fs::exists(existing) && existing.has_relative_path()) existing = existing.parent_path();
  if (!fs::is_directory(existing))
    throw InputError("cannot write results to " + folder.string() + ": " + existing.string() +
                     " is not a folder");
  if (::access(existing.c_str(), W_OK | X_OK) != 0)
    throw InputError("cannot write results to " + folder.string() + ": " + std::strerror(errno));
}

class StudyRun {
 public:
  StudyRun(const Study& study, const StudyOptions& options)
      : study_(study),
        options_(options),
        n_threads_(options.n_threads > 0 ? options.n_threads
                                         : std::max(1U, std::thread::hardware_concurrency())),
        progress_(options.quiet) {}

  void run() {
    // Everything the user gave is checked before the first file is written.
    require_writable(options_.out);
    timed("meshes", [&] {
      prepare_meshes();
      solution_ = make_solution();
      make_solvers();
    });
    begin_writing();
    timed("smoothing", [&] { smooth_meshes(); });
    timed("finite_elements", [&] { solve(); });
    timed("writing", [&] { write_results(); });
    write_provenance("complete");
  }

 private:
  template <class Work>
  void timed(const std::string& phase, const Work& work) {
    const auto started = std::chrono::steady_clock::now();
    work();
    seconds_[phase] =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  }

  void prepare_meshes() {
    progress_.begin("Meshes", study_.meshes.size());
    for (const auto& description : study_.meshes) {
      progress_.update(meshes_.size(), description.name);
      meshes_.push_back(prepare_mesh(description, study_.edge_scale, options_.mesh_dir));
      stop_if_interrupted();
    }
    progress_.end();
  }

  /// Expressions are checked at nodes of the first mesh.
  ManufacturedSolution make_solution() const {
    if (study_.solution.name != "expression") return manufactured_solution(study_.solution.name);
    const auto& points = meshes_.front().mesh.coordinates();
    std::vector<Point<2>> sample;
    for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(1, points.size() / 20))
      sample.push_back(points[i]);
    return parsed_solution(study_.solution.value, study_.solution.gradient, study_.solution.load,
                           sample);
  }

  void make_solvers() {
    for (const auto& prepared : meshes_)
      for (const int degree : study_.degrees) {
        PoissonOptions options = study_.finite_elements;
        options.degree = degree;
        solvers_.emplace_back(prepared.mesh, options);
      }
  }

  /// The provenance first, so that nobody takes old results for those of this run.
  void begin_writing() {
    writing_ = true;
    write_provenance("running");
    for (const auto& prepared : meshes_)
      write_mesh(mesh_path(prepared.description.name, "initial", ".mesh"), prepared.mesh);
    write_provenance("running");  // now with the checksums
  }

  void smooth_meshes() {
    progress_.begin("Smoothing", meshes_.size() * study_.methods.size());
    std::size_t done = 0;
    for (const auto& prepared : meshes_) {
      auto& of_mesh = trajectories_.emplace_back();
      for (const auto& method : study_.methods) {
        progress_.update(done++, prepared.description.name + ", " + method.title);
        of_mesh.push_back(
            record_trajectory(prepared.mesh, method, study_.timing_runs, study_.record_every));
        stop_if_interrupted();
      }
    }
    progress_.end();
  }

  SolveTask* add_task(std::size_t mesh, std::size_t degree, std::vector<Point<2>> coordinates,
                      bool is_result) {
    PlanarMesh smoothed(meshes_[mesh].mesh.shared_topology(), std::move(coordinates));
    return &tasks_.emplace_back(mesh * study_.degrees.size() + degree, std::move(smoothed),
                                is_result || study_.write_series);
  }

  /// Tasks for the initial meshes and for the valid snapshots of every method.
  void make_tasks() {
    for (std::size_t m = 0; m < meshes_.size(); ++m) {
      auto& of_mesh = mesh_tasks_.emplace_back();
      for (std::size_t d = 0; d < study_.degrees.size(); ++d)
        of_mesh.initial.push_back(add_task(m, d, meshes_[m].mesh.coordinates(), true));
      for (const auto& trajectory : trajectories_[m]) {
        auto& of_method = of_mesh.methods.emplace_back();
        for (const auto& snapshot : trajectory.snapshots) {
          auto& of_snapshot = of_method.emplace_back();
          if (trajectory.records[snapshot.record].quality.n_invalid > 0) continue;
          for (std::size_t d = 0; d < study_.degrees.size(); ++d)
            of_snapshot.push_back(
                add_task(m, d, snapshot.coordinates, snapshot.record == trajectory.result_record));
        }
      }
    }
  }

  void solve() {
    make_tasks();
    std::vector<SolveTask*> queue;
    for (auto& task : tasks_) queue.push_back(&task);
    progress_.begin("Finite elements", queue.size());
    work_off(std::move(queue));
    progress_.end();
  }

  /// Waits for the queue; writes the rows there are every few seconds.
  void work_off(std::vector<SolveTask*> tasks) {
    using Clock = std::chrono::steady_clock;
    constexpr auto look = std::chrono::milliseconds(50);
    constexpr auto between_writes = std::chrono::seconds(5);
    SolveQueue queue(std::move(solvers_), *solution_, std::move(tasks), n_threads_);
    auto last_write = Clock::now();
    while (!queue.finished()) {
      std::this_thread::sleep_for(look);
      stop_if_interrupted();
      progress_.update(queue.n_done(), std::to_string(queue.n_done()) + " of " +
                                           std::to_string(tasks_.size()) + " solved");
      if (Clock::now() - last_write < between_writes) continue;
      write_iterations();
      last_write = Clock::now();
    }
    queue.rethrow();
  }

  /// Tasks may be under way on other threads, for a long time: the process ends without them.
  void stop_if_interrupted() {
    if (options_.interrupted == nullptr || !*options_.interrupted) return;
    if (!writing_) {
      progress_.say("Interrupted before the first result.");
      std::_Exit(130);
    }
    const auto rows = write_iterations();
    write_provenance("interrupted");
    progress_.say("Interrupted: the " + std::to_string(rows) + " rows finished so far are in " +
                  (options_.out / "iterations.csv").string() + ".");
    std::_Exit(130);
  }

  fs::path mesh_path(const std::string& mesh, const std::string& method,
                     const std::string& extension) const {
    return options_.out / "meshes" / (mesh + "_" + method + extension);
  }

  /// The rows of one record: one a degree whose task is done, or the reason why there is none.
  void append_rows(std::size_t mesh, std::size_t method, std::size_t record,
                   const std::vector<SolveTask*>& tasks, std::vector<IterationRow>& rows) const {
    IterationRow row{.mesh = meshes_[mesh].description.name,
                     .method = study_.methods[method].name,
                     .iteration = trajectories_[mesh][method].records[record],
                     .degree = 0,
                     .solved = {},
                     .status = {}};
    if (study_.degrees.empty()) {
      row.status = "not solved";
      rows.push_back(row);
    }
    for (std::size_t d = 0; d < study_.degrees.size(); ++d) {
      row.degree = study_.degrees[d];
      row.solved.reset();
      if (tasks.empty()) {
        row.status = "invalid mesh";
      } else {
        if (!tasks[d]->done) continue;
        row.solved = tasks[d]->record;
        row.status = tasks[d]->record.status;
      }
      rows.push_back(row);
    }
  }

  std::vector<IterationRow> finished_rows() const {
    std::vector<IterationRow> rows;
    for (std::size_t m = 0; m < mesh_tasks_.size(); ++m)
      for (std::size_t k = 0; k < study_.methods.size(); ++k) {
        append_rows(m, k, 0, mesh_tasks_[m].initial, rows);
        const auto& snapshots = trajectories_[m][k].snapshots;
        for (std::size_t s = 0; s < snapshots.size(); ++s)
          append_rows(m, k, snapshots[s].record, mesh_tasks_[m].methods[k][s], rows);
      }
    return rows;
  }

  std::size_t write_iterations() const {
    const auto rows = finished_rows();
    write_atomically(options_.out / "iterations.csv", iterations_csv(study_.name, rows));
    return rows.size();
  }

  /// The tasks of a method's resulting mesh; of the initial mesh if the method improved nothing.
  const std::vector<SolveTask*>& result_tasks(std::size_t mesh, std::size_t method) const {
    const auto& trajectory = trajectories_[mesh][method];
    for (std::size_t s = 0; s < trajectory.snapshots.size(); ++s)
      if (trajectory.snapshots[s].record == trajectory.result_record)
        return mesh_tasks_[mesh].methods[method][s];
    return mesh_tasks_[mesh].initial;
  }

  void append_summary(SummaryRow row, const std::vector<SolveTask*>& tasks,
                      std::vector<SummaryRow>& rows) const {
    if (study_.degrees.empty()) {
      row.status = "not solved";
      rows.push_back(row);
    }
    for (std::size_t d = 0; d < study_.degrees.size(); ++d) {
      row.degree = study_.degrees[d];
      row.status = tasks.empty() ? "invalid mesh" : tasks[d]->record.status;
      row.solved = tasks.empty() ? std::nullopt : std::optional(tasks[d]->record);
      rows.push_back(row);
    }
  }

  std::vector<SummaryRow> summary_rows() const {
    std::vector<SummaryRow> rows;
    for (std::size_t m = 0; m < meshes_.size(); ++m) {
      const std::string& name = meshes_[m].description.name;
      append_summary({.mesh = name, .method = "initial", .quality = meshes_[m].quality},
                     mesh_tasks_[m].initial, rows);
      for (std::size_t k = 0; k < study_.methods.size(); ++k) {
        const auto& trajectory = trajectories_[m][k];
        append_summary({.mesh = name,
                        .method = study_.methods[k].name,
                        .iterations = trajectory.iterations_text,
                        .smoothing_seconds = trajectory.smoothing_seconds,
                        .quality = trajectory.quality},
                       result_tasks(m, k), rows);
      }
    }
    return rows;
  }

  MeshFields fields_of(const PlanarMesh& mesh, const std::vector<SolveTask*>& tasks) const {
    MeshFields fields;
    fields.cell["mean_ratio"] = cell_mean_ratios(mesh);
    auto& exact = fields.point["exact_solution"];
    for (const auto& p : mesh.coordinates()) exact.push_back(solution_->value(p));
    for (std::size_t d = 0; d < tasks.size(); ++d)
      fields.point["nodal_error_d" + std::to_string(study_.degrees[d])] = tasks[d]->nodal_errors;
    return fields;
  }

  PlanarMesh result_mesh(std::size_t mesh, std::size_t method) const {
    const auto& trajectory = trajectories_[mesh][method];
    for (const auto& snapshot : trajectory.snapshots)
      if (snapshot.record == trajectory.result_record)
        return {meshes_[mesh].mesh.shared_topology(), snapshot.coordinates};
    return meshes_[mesh].mesh;
  }

  void write_meshes() const {
    for (std::size_t m = 0; m < meshes_.size(); ++m) {
      const std::string& name = meshes_[m].description.name;
      write_mesh(mesh_path(name, "initial", ".vtu"), meshes_[m].mesh,
                 fields_of(meshes_[m].mesh, mesh_tasks_[m].initial));
      for (std::size_t k = 0; k < study_.methods.size(); ++k) {
        const PlanarMesh mesh = result_mesh(m, k);
        write_mesh(mesh_path(name, study_.methods[k].name, ".vtu"), mesh,
                   fields_of(mesh, result_tasks(m, k)));
        if (study_.write_series) write_series(m, k);
      }
    }
  }

  void write_series(std::size_t m, std::size_t k) const {
    const std::string& name = meshes_[m].description.name;
    VtuSeries series(mesh_path(name, study_.methods[k].name, ".pvd"));
    series.add(0.0, meshes_[m].mesh, fields_of(meshes_[m].mesh, mesh_tasks_[m].initial));
    const auto& snapshots = trajectories_[m][k].snapshots;
    for (std::size_t s = 0; s < snapshots.size(); ++s) {
      const PlanarMesh mesh(meshes_[m].mesh.shared_topology(), snapshots[s].coordinates);
      series.add(static_cast<double>(snapshots[s].record), mesh,
                 fields_of(mesh, mesh_tasks_[m].methods[k][s]));
    }
  }

  void write_results() {
    progress_.begin("Results", 0);
    write_iterations();
    write_atomically(options_.out / "summary.csv", summary_csv(study_.name, summary_rows()));
    const auto thresholds = study_.thresholds.reference.empty()
                                ? std::vector<ThresholdRow>()
                                : reach_thresholds(finished_rows(), study_.thresholds.reference,
                                                   study_.thresholds.margin);
    write_atomically(options_.out / "thresholds.csv", thresholds_csv(study_.name, thresholds));
    write_meshes();
    progress_.end();
  }

  void write_provenance(const std::string& status) const {
    write_atomically(options_.out / "provenance.json",
                     provenance_json({study_, options_, meshes_, n_threads_, status, seconds_}));
  }

  const Study& study_;
  const StudyOptions& options_;
  unsigned int n_threads_;
  mutable Progress progress_;
  std::optional<ManufacturedSolution> solution_;
  std::vector<PreparedMesh> meshes_;
  std::vector<PoissonSolver> solvers_;  ///< [mesh * number of degrees + degree]
  bool writing_ = false;                ///< the folder of the results holds files of this run
  std::vector<std::vector<Trajectory>> trajectories_;  ///< [mesh][method]
  std::list<SolveTask> tasks_;                         ///< stay where they are
  std::vector<MeshTasks> mesh_tasks_;
  std::map<std::string, double> seconds_;
};

}  // namespace

void run_study(const Study& study, const StudyOptions& options) {
  StudyRun(study, options).run();
}

}  // namespace smoothfem
