#include "studies/framework/run_study.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "meshes/io/atomic_file.h"
#include "meshes/io/mesh_file.h"
#include "studies/framework/progress.h"
#include "studies/framework/provenance.h"
#include "studies/framework/study_data.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;

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
        progress_(options.quiet),
        data_{study} {}

  void run() {
    // Everything the user gave is checked before the first file is written.
    require_writable(options_.out);
    require_published_files();
    timed("meshes", [&] {
      prepare_meshes();
      data_.solution = make_solution();
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

  /// --mesh-dir must not be taken for something that it does not do.
  void require_published_files() const {
    if (options_.mesh_dir.empty()) return;
    for (const auto& mesh : study_.meshes)
      if (!mesh.published_file.empty()) return;
    throw InputError("--mesh-dir is given, but no mesh of the study " + study_.name +
                     " names a published file; leave it out or set 'published file' for a mesh");
  }

  void prepare_meshes() {
    progress_.begin("Meshes", study_.meshes.size());
    for (const auto& description : study_.meshes) {
      progress_.update(data_.meshes.size(), description.name);
      data_.meshes.push_back(prepare_mesh(description, study_.edge_scale, options_.mesh_dir));
      stop_if_interrupted();
    }
    progress_.end();
  }

  /// Expressions are checked at nodes of the first mesh.
  ManufacturedSolution make_solution() const {
    if (study_.solution.name != "expression") return manufactured_solution(study_.solution.name);
    const auto& points = data_.meshes.front().mesh.coordinates();
    std::vector<Point<2>> sample;
    for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(1, points.size() / 20))
      sample.push_back(points[i]);
    return parsed_solution(study_.solution.value, study_.solution.gradient, study_.solution.load,
                           sample);
  }

  void make_solvers() {
    for (const auto& prepared : data_.meshes)
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
    for (const auto& prepared : data_.meshes)
      write_mesh(mesh_path(options_.out, prepared.description.name, "initial", ".mesh"),
                 prepared.mesh);
    write_provenance("running");  // now with the checksums
  }

  void smooth_meshes() {
    progress_.begin("Smoothing", data_.meshes.size() * study_.methods.size());
    std::size_t done = 0;
    for (const auto& prepared : data_.meshes) {
      auto& of_mesh = data_.trajectories.emplace_back();
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
    PlanarMesh smoothed(data_.meshes[mesh].mesh.shared_topology(), std::move(coordinates));
    return &data_.tasks.emplace_back(mesh * study_.degrees.size() + degree, std::move(smoothed),
                                     is_result || study_.write_series);
  }

  /// Tasks for the initial meshes and for the valid snapshots of every method.
  void make_tasks() {
    for (std::size_t m = 0; m < data_.meshes.size(); ++m) {
      auto& of_mesh = data_.mesh_tasks.emplace_back();
      for (std::size_t d = 0; d < study_.degrees.size(); ++d)
        of_mesh.initial.push_back(add_task(m, d, data_.meshes[m].mesh.coordinates(), true));
      for (const auto& trajectory : data_.trajectories[m]) {
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
    for (auto& task : data_.tasks) queue.push_back(&task);
    progress_.begin("Finite elements", queue.size());
    work_off(std::move(queue));
    progress_.end();
  }

  /// Waits for the queue; writes the rows there are every few seconds.
  void work_off(std::vector<SolveTask*> tasks) {
    using Clock = std::chrono::steady_clock;
    constexpr auto look = std::chrono::milliseconds(50);
    constexpr auto between_writes = std::chrono::seconds(5);
    SolveQueue queue(std::move(solvers_), *data_.solution, std::move(tasks), n_threads_);
    auto last_write = Clock::now();
    while (!queue.finished()) {
      std::this_thread::sleep_for(look);
      stop_if_interrupted();
      progress_.update(queue.n_done(), std::to_string(queue.n_done()) + " of " +
                                           std::to_string(data_.tasks.size()) + " solved");
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

  std::size_t write_iterations() const {
    const auto rows = finished_rows(data_);
    write_atomically(options_.out / "iterations.csv", iterations_csv(study_.name, rows));
    return rows.size();
  }

  void write_results() {
    progress_.begin("Results", 0);
    write_iterations();
    write_atomically(options_.out / "summary.csv", summary_csv(study_.name, summary_rows(data_)));
    const auto thresholds =
        study_.thresholds.reference.empty()
            ? std::vector<ThresholdRow>()
            : reach_thresholds(finished_rows(data_), study_.thresholds.reference,
                               study_.thresholds.margin);
    write_atomically(options_.out / "thresholds.csv", thresholds_csv(study_.name, thresholds));
    write_meshes(data_, options_.out);
    progress_.end();
  }

  void write_provenance(const std::string& status) const {
    write_atomically(
        options_.out / "provenance.json",
        provenance_json({study_, options_, data_.meshes, n_threads_, status, seconds_}));
  }

  const Study& study_;
  const StudyOptions& options_;
  unsigned int n_threads_;
  mutable Progress progress_;
  StudyData data_;
  std::vector<PoissonSolver> solvers_;  ///< [mesh * number of degrees + degree]
  bool writing_ = false;                ///< the folder of the results holds files of this run
  std::map<std::string, double> seconds_;
};

}  // namespace

void run_study(const Study& study, const StudyOptions& options) {
  StudyRun(study, options).run();
}

}  // namespace smoothfem
