// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/study_data.h"

#include <algorithm>

#include "meshes/io/mesh_file.h"
#include "meshes/io/vtu_series.h"
#include "smoothing/quality/cell_targets.h"
#include "studies/framework/run/kept/result_names.h"

namespace smoothfem {

namespace {

using Tasks = std::vector<SolveTask*>;

/// The columns of a row that solvers fill.
struct Outcome {
  int degree = 0;
  std::optional<SolutionRecord> solved{};
  std::string status{};
  SolverNumbers numbers{};
};

/// Returns the outcomes for Poisson's equation: one per degree whose task is done, or one with the
/// reason why there are no numbers.
std::vector<Outcome> outcomes(const std::vector<int>& degrees, const Tasks& tasks, bool invalid) {
  if (degrees.empty()) return {{.status = invalid ? invalid_mesh : "not solved"}};
  std::vector<Outcome> result;
  for (std::size_t d = 0; d < degrees.size(); ++d) {
    const int degree = degrees[d];
    if (invalid)
      result.push_back({.degree = degree, .status = invalid_mesh});
    else if (tasks[d] != nullptr && tasks[d]->done)
      result.push_back({degree, tasks[d]->solution, tasks[d]->solution.status});
  }
  return result;
}

/// Adds what one solve has found to a row. The row's status is "ok" if that of all solves is.
void add_solve(const StudySolve& solve, const SolutionRecord& found, Outcome& row) {
  std::string status = found.status;
  if (solve.solver == nullptr) {
    row.solved = found;
  } else {
    for (const auto& [name, value] : found.numbers)
      row.numbers.emplace_back(solve.solver->label + "." + name, value);
    if (status != "ok") status = solve.solver->label + ": " + status;
  }
  if (row.status.empty() || row.status == "ok")
    row.status = status;
  else if (status != "ok")
    row.status += "; " + status;
}

/// Returns the outcomes of all solvers: one for each degree of the rows whose tasks are done.
std::vector<Outcome> outcomes_of_all(const Study& study, const std::vector<StudySolve>& solves,
                                     const Tasks& tasks, bool invalid) {
  if (study.solvers.empty()) return outcomes(study.degrees, tasks, invalid);
  std::vector<Outcome> rows;
  for (const int degree : row_degrees(study)) {
    Outcome row{.degree = degree, .status = invalid ? invalid_mesh : ""};
    bool is_done = true;
    for (std::size_t s = 0; s < solves.size() && !invalid; ++s) {
      if (solves[s].degree != 0 && solves[s].degree != degree) continue;
      is_done = is_done && tasks[s] != nullptr && tasks[s]->done;
      if (is_done) add_solve(solves[s], tasks[s]->solution, row);
    }
    if (is_done) rows.push_back(std::move(row));
  }
  return rows;
}

template <int dim, int spacedim>
void append_rows(const StudyData<dim, spacedim>& data, std::size_t mesh, std::size_t method,
                 std::size_t record, const Tasks& tasks, std::vector<IterationRow>& rows) {
  const Trajectory& trajectory = data.trajectories[mesh][method];
  const IterationRecord& iteration = trajectory.records[record];
  const auto warpage = record < trajectory.warpage_of_records.size()
                           ? std::optional(trajectory.warpage_of_records[record])
                           : std::nullopt;
  for (auto& outcome :
       outcomes_of_all(data.study, data.solves, tasks, iteration.quality.n_invalid > 0))
    rows.push_back({data.meshes[mesh].description.name, data.study.methods[method].name, iteration,
                    warpage, outcome.degree, std::move(outcome.solved), std::move(outcome.status),
                    std::move(outcome.numbers)});
}

/// Appends rows of summary.csv. failure: why the row has no result; empty if it has one.
void append_summary(const Study& study, const std::vector<StudySolve>& solves, SummaryRow row,
                    const Tasks& tasks, const std::string& failure, std::vector<SummaryRow>& rows) {
  for (auto& outcome : outcomes_of_all(study, solves, tasks, row.quality.n_invalid > 0)) {
    row.degree = outcome.degree;
    row.solved = failure.empty() ? std::move(outcome.solved) : std::nullopt;
    row.numbers = failure.empty() ? std::move(outcome.numbers) : SolverNumbers();
    row.status = failure.empty() ? std::move(outcome.status) : "failed: " + failure;
    rows.push_back(row);
  }
}

/// Returns the tasks of a method's resulting mesh. If the method improved nothing, they are those
/// of the initial mesh.
template <int dim, int spacedim>
const Tasks& result_tasks(const StudyData<dim, spacedim>& data, std::size_t mesh,
                          std::size_t method) {
  const auto& trajectory = data.trajectories[mesh][method];
  for (std::size_t s = 0; s < trajectory.snapshots.size(); ++s)
    if (trajectory.snapshots[s] == trajectory.result_record)
      return data.mesh_tasks[mesh].methods[method][s];
  return data.mesh_tasks[mesh].initial;
}

/// Returns a mesh of a trajectory; record 0 is the initial mesh.
template <int dim, int spacedim>
Mesh<dim, spacedim> mesh_of(const StudyData<dim, spacedim>& data, std::size_t m, std::size_t k,
                            std::size_t record) {
  const auto& mesh = data.meshes[m].mesh;
  if (record == 0) return mesh;
  return {mesh.shared_topology(), data.load_coordinates(m, data.trajectory_names[m][k], record),
          mesh.shared_constraints()};
}

template <int dim, int spacedim>
MeshFields fields_of(const StudyData<dim, spacedim>& data, std::size_t m,
                     const Mesh<dim, spacedim>& mesh, const Tasks& tasks) {
  MeshFields fields;
  fields.cell["mean_ratio"] = cell_mean_ratios(mesh);
  if (data.solutions.empty()) return fields;
  auto& exact = fields.point["exact_solution"];
  for (const auto& p : mesh.coordinates()) exact.push_back(data.solutions[m].front().value(p));
  for (std::size_t d = 0; d < std::min(tasks.size(), data.study.degrees.size()); ++d)
    if (tasks[d] != nullptr)
      fields.point["nodal_error_d" + std::to_string(data.study.degrees[d])] =
          data.kept.load_numbers(tasks[d]->job.name, tasks[d]->record, mesh.n_nodes());
  return fields;
}

template <int dim, int spacedim>
void write_series(const StudyData<dim, spacedim>& data, std::size_t m, std::size_t k,
                  const std::filesystem::path& out) {
  const PreparedMesh<dim, spacedim>& prepared = data.meshes[m];
  VtuSeries series(mesh_path(out, prepared.description.name, data.study.methods[k].name, ".pvd"));
  series.add(0.0, prepared.mesh, fields_of(data, m, prepared.mesh, data.mesh_tasks[m].initial));
  const auto& snapshots = data.trajectories[m][k].snapshots;
  for (std::size_t s = 0; s < snapshots.size(); ++s) {
    const Mesh<dim, spacedim> mesh = mesh_of(data, m, k, snapshots[s]);
    series.add(static_cast<double>(snapshots[s]), mesh,
               fields_of(data, m, mesh, data.mesh_tasks[m].methods[k][s]));
  }
}

/// Makes jobs and their tasks together. Rows find tasks by snapshot.
template <int dim, int spacedim>
class TaskMaker {
 public:
  explicit TaskMaker(StudyData<dim, spacedim>& data) : data_(data) {}

  void make() {
    for (std::size_t m = 0; m < data_.meshes.size(); ++m) {
      auto& of_mesh = data_.mesh_tasks.emplace_back();
      for (const auto& trajectory : data_.trajectories[m])
        of_mesh.methods.emplace_back(trajectory.snapshots.size());
      for (std::size_t s = 0; s < data_.solves.size(); ++s) make_solve(m, s, of_mesh);
      make_refined(m, of_mesh);
      make_further(m, of_mesh);
    }
  }

 private:
  void make_solve(std::size_t m, std::size_t solve, MeshTasks& of_mesh) {
    of_mesh.initial.push_back(add_task(add_job(m, solve, 0), 0, true));
    for (std::size_t k = 0; k < data_.study.methods.size(); ++k) {
      SolveJob& job = add_job(m, solve, k + 1);
      const Trajectory& trajectory = data_.trajectories[m][k];
      for (std::size_t s = 0; s < trajectory.snapshots.size(); ++s) {
        const std::size_t record = trajectory.snapshots[s];
        if (trajectory.records[record].quality.n_invalid > 0) continue;
        const bool is_result = record == trajectory.result_record;
        const bool is_taken = is_result || s + 1 == trajectory.snapshots.size() ||
                              is_recorded(data_.study, data_.solves[solve].degree);
        of_mesh.methods[k][s].push_back(is_taken ? add_task(job, record, is_result) : nullptr);
      }
    }
  }

  void make_refined(std::size_t m, MeshTasks& of_mesh) {
    const auto& degrees = data_.study.degrees;
    of_mesh.refined.resize(data_.study.methods.size() + 1);
    for (const int degree : data_.study.refined_degrees) {
      const auto d = static_cast<std::size_t>(std::find(degrees.begin(), degrees.end(), degree) -
                                              degrees.begin());
      for_each_result(m, [&](std::size_t k, std::size_t record) {
        of_mesh.refined[k].push_back(add_task(add_job(m, d, k, true), record, true));
      });
    }
  }

  void make_further(std::size_t m, MeshTasks& of_mesh) {
    const Study& study = data_.study;
    of_mesh.further.assign(study.methods.size() + 1,
                           std::vector<Tasks>(study.further_solutions.size()));
    for (std::size_t s = 0; s < study.further_solutions.size(); ++s)
      for (std::size_t d = 0; d < study.degrees.size(); ++d)
        for_each_result(m, [&](std::size_t k, std::size_t record) {
          of_mesh.further[k][s].push_back(add_task(add_job(m, d, k, false, s + 1), record, true));
        });
  }

  /// Calls visit(method plus one, record) for the initial mesh (0) and each method's result. It
  /// skips results that are the initial mesh or not valid.
  template <class Visit>
  void for_each_result(std::size_t m, const Visit& visit) {
    if (data_.meshes[m].quality.n_invalid == 0) visit(0, 0);
    for (std::size_t k = 0; k < data_.study.methods.size(); ++k) {
      const Trajectory& trajectory = data_.trajectories[m][k];
      if (trajectory.result_record > 0 && trajectory.quality.n_invalid == 0)
        visit(k + 1, trajectory.result_record);
    }
  }

  /// method: its index plus one; 0: the initial mesh.
  SolveJob& add_job(std::size_t m, std::size_t solve, std::size_t method, bool is_refined = false,
                    std::size_t solution = 0) {
    const bool is_initial = method == 0;
    const std::string name =
        solved_name({.mesh_content = data_.mesh_contents[m],
                     .trajectory = is_initial ? "" : data_.trajectories[m][method - 1].content,
                     .degree = data_.solves[solve].degree,
                     .is_refined = is_refined,
                     .is_further = solution > 0,
                     .ties = data_.meshes[m].ties.get(),
                     .solver = data_.solves[solve].solver},
                    *solutions_of(data_.study)[solution], data_.study);
    SolveJob& job =
        data_.jobs.emplace_back(name, is_initial ? "" : data_.trajectory_names[m][method - 1], m,
                                solve, method, is_refined, solution);
    job.solved.session = data_.session;
    if (auto solved = data_.kept.load_solved(job.name)) job.solved = std::move(*solved);
    return job;
  }

  SolveTask* add_task(SolveJob& job, std::size_t record, bool is_result) {
    SolveTask& task = data_.tasks.emplace_back(job, record, is_result);
    ++job.n_tasks;
    const auto found = job.solved.records.find(record);
    if (found != job.solved.records.end()) {
      task.solution = found->second;
      task.seconds = job.solved.seconds[record];
      task.done = true;
    }
    return &task;
  }

  StudyData<dim, spacedim>& data_;
};

}  // namespace

template <int dim, int spacedim>
std::vector<Point<spacedim>> StudyData<dim, spacedim>::load_coordinates(
    std::size_t mesh, const std::string& trajectory, std::size_t record) const {
  const auto& prepared = meshes[mesh];
  if constexpr (dim == spacedim)
    if (prepared.parts) return prepared.parts->load(kept, trajectory, record);
  return points_of<spacedim>(kept.load_numbers(
      trajectory, record, static_cast<std::size_t>(spacedim) * prepared.mesh.n_nodes()));
}

template <int dim, int spacedim>
std::vector<Point<spacedim>> StudyData<dim, spacedim>::coordinates_of(const SolveTask& task) const {
  const SolveJob& job = task.job;
  if (job.trajectory.empty()) return meshes[job.mesh].mesh.copied_coordinates();
  return load_coordinates(job.mesh, job.trajectory, task.record);
}

template <int dim, int spacedim>
SolveKind StudyData<dim, spacedim>::kind_of(const SolveTask& task) const {
  const SolveJob& job = task.job;
  // A refined mesh has 2^dim times as many nodes, and its own costs.
  const double times = job.is_refined ? 1 << dim : 1;
  return {.mesh = job.mesh,
          .method = job.method + (job.is_refined ? study.methods.size() + 1 : 0),
          .degree = job.solve,
          .is_initial = job.method == 0,
          .is_result = task.is_result,
          .n_nodes = times * static_cast<double>(meshes[job.mesh].n_nodes),
          .dimension = dim,
          .polynomial_degree = std::max(1, solves[job.solve].degree),
          .record = task.record};
}

template <int dim, int spacedim>
void make_tasks(StudyData<dim, spacedim>& data) {
  TaskMaker<dim, spacedim>(data).make();
}

void finish_task(SolveTask& task, SolutionRecord solution, double seconds,
                 std::vector<double> eigenvectors, const KeptResults& kept) {
  constexpr auto between_saves = std::chrono::seconds(1);
  SolveJob& job = task.job;
  const std::lock_guard guard(job.mutex);
  task.solution = solution;
  task.seconds = seconds;
  job.solved.seconds[task.record] = seconds;
  job.solved.records[task.record] = std::move(solution);
  job.solved.eigenvectors = std::move(eigenvectors);
  const auto now = std::chrono::steady_clock::now();
  if (job.solved.records.size() == job.n_tasks || now - job.saved > between_saves) {
    kept.save(job.name, job.solved);
    job.saved = now;
  }
  task.done = true;
}

template <int dim, int spacedim>
std::vector<IterationRow> finished_rows(const StudyData<dim, spacedim>& data) {
  std::vector<IterationRow> rows;
  for (std::size_t m = 0; m < data.mesh_tasks.size(); ++m)
    for (std::size_t k = 0; k < data.study.methods.size(); ++k) {
      append_rows(data, m, k, 0, data.mesh_tasks[m].initial, rows);
      const auto& snapshots = data.trajectories[m][k].snapshots;
      for (std::size_t s = 0; s < snapshots.size(); ++s)
        append_rows(data, m, k, snapshots[s], data.mesh_tasks[m].methods[k][s], rows);
    }
  return rows;
}

template <int dim, int spacedim>
std::vector<SummaryRow> summary_rows(const StudyData<dim, spacedim>& data) {
  std::vector<SummaryRow> rows;
  for (std::size_t m = 0; m < data.meshes.size(); ++m) {
    const std::string& name = data.meshes[m].description.name;
    append_summary(data.study, data.solves,
                   {.mesh = name,
                    .method = "initial",
                    .quality = data.meshes[m].quality,
                    .cells_below = count_cells_below(data.meshes[m].mesh, data.study.count_below),
                    .warpage = warpage_of(data.meshes[m].mesh)},
                   data.mesh_tasks[m].initial, "", rows);
    for (std::size_t k = 0; k < data.study.methods.size(); ++k) {
      const auto& trajectory = data.trajectories[m][k];
      append_summary(data.study, data.solves,
                     {.mesh = name,
                      .method = data.study.methods[k].name,
                      .iterations = trajectory.iterations_text,
                      .smoothing_seconds = trajectory.smoothing_seconds,
                      .preparation_seconds = trajectory.preparation_seconds,
                      .wall_seconds = trajectory.wall_seconds,
                      .quality = trajectory.quality,
                      .cells_below = trajectory.cells_below,
                      .warpage = trajectory.warpage,
                      .peak_memory_gib = trajectory.peak_memory_gib},
                     result_tasks(data, m, k), trajectory.failure, rows);
    }
  }
  return rows;
}

template <int dim, int spacedim>
std::vector<SolutionRow> solution_rows(const StudyData<dim, spacedim>& data) {
  std::vector<SolutionRow> rows;
  const auto solutions = solutions_of(data.study);
  for (std::size_t m = 0; m < data.meshes.size(); ++m) {
    const auto append = [&](const std::string& method, std::size_t s, const Tasks& tasks,
                            bool invalid, const std::string& failure) {
      for (auto& outcome : outcomes(data.study.degrees, tasks, invalid)) {
        if (!failure.empty()) outcome = {.degree = outcome.degree, .status = "failed: " + failure};
        rows.push_back({data.meshes[m].description.name, method, solutions[s]->label,
                        outcome.degree, std::move(outcome.solved), std::move(outcome.status)});
      }
    };
    const auto& tasks = data.mesh_tasks[m];
    const bool invalid = data.meshes[m].quality.n_invalid > 0;
    for (std::size_t s = 0; s < solutions.size(); ++s)
      append("initial", s, s == 0 ? tasks.initial : tasks.further[0][s - 1], invalid, "");
    for (std::size_t k = 0; k < data.study.methods.size(); ++k) {
      const Trajectory& trajectory = data.trajectories[m][k];
      const auto& further = tasks.further[trajectory.result_record == 0 ? 0 : k + 1];
      for (std::size_t s = 0; s < solutions.size(); ++s)
        append(data.study.methods[k].name, s, s == 0 ? result_tasks(data, m, k) : further[s - 1],
               trajectory.quality.n_invalid > 0, trajectory.failure);
    }
  }
  return rows;
}

template <int dim, int spacedim>
std::vector<RefinedRow> refined_rows(const StudyData<dim, spacedim>& data) {
  std::vector<RefinedRow> rows;
  if (data.study.refined_degrees.empty()) return rows;
  for (std::size_t m = 0; m < data.meshes.size(); ++m) {
    const auto& refined = data.mesh_tasks[m].refined;
    const auto append = [&](const std::string& method, const Tasks& tasks, bool invalid,
                            const std::string& failure) {
      for (auto& outcome : outcomes(data.study.refined_degrees, tasks, invalid)) {
        if (!failure.empty()) outcome.status = "failed: " + failure;
        if (!failure.empty() || outcome.status == invalid_mesh) outcome.solved.reset();
        rows.push_back({data.meshes[m].description.name, method, outcome.degree,
                        std::move(outcome.solved), std::move(outcome.status)});
      }
    };
    append("initial", refined[0], data.meshes[m].quality.n_invalid > 0, "");
    for (std::size_t k = 0; k < data.study.methods.size(); ++k) {
      const Trajectory& trajectory = data.trajectories[m][k];
      append(data.study.methods[k].name, refined[trajectory.result_record == 0 ? 0 : k + 1],
             trajectory.quality.n_invalid > 0, trajectory.failure);
    }
  }
  return rows;
}

namespace {

/// Returns the statistics of each metric. targets: the initial cells; null for surface meshes.
template <int dim, int spacedim>
std::vector<MetricStatistics> statistics_of(
    const std::vector<const Metric*>& metrics, const Mesh<dim, spacedim>& mesh,
    const std::shared_ptr<const CellTargets<dim>>& targets) {
  std::vector<MetricStatistics> statistics;
  for (const Metric* metric : metrics) {
    if constexpr (dim == spacedim)
      if (metric->compares_with_initial) {
        const Mesh<dim> compared = with_targets(mesh, targets);
        statistics.push_back(metric_statistics(*metric, &compared));
        continue;
      }
    statistics.push_back(metric_statistics(*metric, &mesh));
  }
  return statistics;
}

/// Returns the cells of a mesh as targets if some metric needs them; null otherwise, and if cells
/// are invalid.
template <int dim, int spacedim>
std::shared_ptr<const CellTargets<dim>> targets_for(const std::vector<const Metric*>& metrics,
                                                    const PreparedMesh<dim, spacedim>& initial) {
  if constexpr (dim == spacedim)
    for (const Metric* metric : metrics)
      if (metric->compares_with_initial && initial.quality.n_invalid == 0)
        return targets_of(initial.mesh, TargetKind::shape_and_size);
  return nullptr;
}

}  // namespace

template <int dim, int spacedim>
std::vector<MetricRow> metric_rows(const StudyData<dim, spacedim>& data,
                                   const std::function<void()>& watch) {
  const auto& metrics = data.study.metrics;
  std::vector<MetricRow> rows;
  if (metrics.empty()) return rows;
  for (std::size_t m = 0; m < data.meshes.size(); ++m) {
    const std::string& name = data.meshes[m].description.name;
    const auto targets = targets_for(metrics, data.meshes[m]);
    const auto initial = statistics_of(metrics, data.meshes[m].mesh, targets);
    for (std::size_t k = 0; k < data.study.methods.size(); ++k) {
      const Trajectory& trajectory = data.trajectories[m][k];
      const auto append = [&](std::size_t record, const std::vector<MetricStatistics>& values) {
        const IterationRecord& iteration = trajectory.records[record];
        for (std::size_t i = 0; i < metrics.size(); ++i)
          if (values[i].n_cells > 0)
            rows.push_back({name, data.study.methods[k].name, iteration.stage, iteration.iteration,
                            metrics[i]->larger_is_better, values[i]});
        watch();
      };
      append(0, initial);
      for (const std::size_t record : trajectory.snapshots) {
        const Mesh<dim, spacedim> mesh = mesh_of(data, m, k, record);
        append(record, statistics_of(metrics, mesh, targets));
      }
    }
  }
  return rows;
}

namespace {

/// Returns the degree of Poisson's equation, or "LABEL" or "LABEL 2" for another solver.
std::string solve_name(const StudySolve& solve) {
  const std::string degree = std::to_string(solve.degree);
  if (solve.solver == nullptr) return degree;
  return solve.solver->label + (solve.degree > 0 ? " " + degree : "");
}

}  // namespace

template <int dim, int spacedim>
std::vector<ResultSessions> sessions_of(const StudyData<dim, spacedim>& data) {
  std::vector<ResultSessions> all;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> places;  // by mesh, method plus one
  for (std::size_t m = 0; m < data.meshes.size(); ++m)
    for (std::size_t k = 0; k <= data.study.methods.size(); ++k) {
      places[{m, k}] = all.size();
      all.push_back({.mesh = data.meshes[m].description.name,
                     .method = k == 0 ? "initial" : data.study.methods[k - 1].name,
                     .smoothed = k == 0 ? "" : data.trajectories[m][k - 1].session,
                     .solved = {}});
    }
  for (const auto& job : data.jobs)
    if (job.n_tasks > 0 && !job.is_refined && job.solution == 0)
      all[places.at({job.mesh, job.method})].solved[solve_name(data.solves[job.solve])] =
          job.solved.session;
  return all;
}

template <int dim, int spacedim>
std::set<std::string> names_of_kept(const StudyData<dim, spacedim>& data) {
  std::set<std::string> names;
  for (const auto& mesh : data.meshes)
    if (!mesh.kept_name.empty()) names.insert(mesh.kept_name);
  for (const auto& of_mesh : data.trajectory_names) names.insert(of_mesh.begin(), of_mesh.end());
  for (const auto& job : data.jobs) names.insert(job.name);
  return names;
}

std::filesystem::path mesh_path(const std::filesystem::path& out, const std::string& mesh,
                                const std::string& method, const std::string& extension) {
  return out / "meshes" / (mesh + "_" + method + extension);
}

template <int dim, int spacedim>
void write_meshes(const StudyData<dim, spacedim>& data, const std::filesystem::path& out) {
  for (std::size_t m = 0; m < data.meshes.size(); ++m) {
    const PreparedMesh<dim, spacedim>& prepared = data.meshes[m];
    const std::string& name = prepared.description.name;
    if constexpr (dim == spacedim)
      if (prepared.parts) {
        for (std::size_t k = 0; k < data.study.methods.size(); ++k) {
          const auto result = mesh_of(data, m, k, data.trajectories[m][k].result_record);
          prepared.parts->write(
              mesh_path(out, name, data.study.methods[k].name, prepared.parts->extension()),
              result.coordinates());
        }
        continue;
      }
    write_mesh(mesh_path(out, name, "initial", ".vtu"), prepared.mesh,
               fields_of(data, m, prepared.mesh, data.mesh_tasks[m].initial));
    for (std::size_t k = 0; k < data.study.methods.size(); ++k) {
      const Mesh<dim, spacedim> result = mesh_of(data, m, k, data.trajectories[m][k].result_record);
      write_mesh(mesh_path(out, name, data.study.methods[k].name, ".vtu"), result,
                 fields_of(data, m, result, result_tasks(data, m, k)));
      if (data.study.write_series) write_series(data, m, k, out);
    }
  }
}

#define SMOOTHFEM_INSTANTIATE(...)                                                 \
  template struct StudyData<__VA_ARGS__>;                                          \
  template void make_tasks(StudyData<__VA_ARGS__>&);                               \
  template std::vector<IterationRow> finished_rows(const StudyData<__VA_ARGS__>&); \
  template std::vector<RefinedRow> refined_rows(const StudyData<__VA_ARGS__>&);    \
  template std::vector<SolutionRow> solution_rows(const StudyData<__VA_ARGS__>&);  \
  template std::vector<SummaryRow> summary_rows(const StudyData<__VA_ARGS__>&);    \
  template std::vector<MetricRow> metric_rows(const StudyData<__VA_ARGS__>&,       \
                                              const std::function<void()>&);       \
  template std::vector<ResultSessions> sessions_of(const StudyData<__VA_ARGS__>&); \
  template std::set<std::string> names_of_kept(const StudyData<__VA_ARGS__>&);     \
  template void write_meshes(const StudyData<__VA_ARGS__>&, const std::filesystem::path&);
SMOOTHFEM_INSTANTIATE(2, 2)
SMOOTHFEM_INSTANTIATE(3, 3)
SMOOTHFEM_INSTANTIATE(2, 3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
