// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <list>
#include <mutex>
#include <set>
#include <vector>

#include "studies/framework/results/results.h"
#include "studies/framework/run/kept/kept_results.h"
#include "studies/framework/run/solve_costs.h"
#include "studies/framework/run/study_meshes.h"
#include "studies/framework/run/trajectory.h"

namespace smoothfem {

/// The status of meshes with invalid cells, which are not solved.
inline constexpr const char* invalid_mesh = "invalid mesh";

/// The records of one mesh, method (or the initial mesh) and solve. They are kept together.
struct SolveJob {
  SolveJob(std::string name_, std::string trajectory_, std::size_t mesh_, std::size_t solve_,
           std::size_t method_, bool is_refined_, std::size_t solution_)
      : name(std::move(name_)),
        trajectory(std::move(trajectory_)),
        mesh(mesh_),
        solve(solve_),
        method(method_),
        is_refined(is_refined_),
        solution(solution_) {}

  std::string name;         ///< of its kept results
  std::string trajectory;   ///< name of the kept trajectory; empty: the initial mesh
  std::size_t mesh, solve;  ///< indices into the study's meshes and solves
  std::size_t method;       ///< index into the study's methods plus one; 0: the initial mesh
  bool is_refined;          ///< of the mesh with split cells
  std::size_t solution;     ///< index into the study's solutions; 0: that of the records
  std::size_t n_tasks = 0;
  SolvedRecords solved{};
  std::chrono::steady_clock::time_point saved{};
  std::mutex mutex{};  ///< for `solved` and `saved`
};

/// A record to be made: the numbers of a solver.
struct SolveTask {
  SolveTask(SolveJob& job_, std::size_t record_, bool is_result_)
      : job(job_), record(record_), is_result(is_result_) {}

  SolveJob& job;
  std::size_t record;  ///< of the trajectory
  bool is_result;      ///< an initial or resulting mesh
  SolutionRecord solution{};
  double seconds = 0.0;           ///< of the solve
  std::atomic<bool> done{false};  ///< set last; if true, other threads may read the other fields
};

/// The tasks of one mesh: those of the initial mesh, which all methods share, and those of each
/// method's snapshots. Each list has one task per solve, or none if the mesh is invalid.
struct MeshTasks {
  std::vector<SolveTask*> initial;
  /// By [method][snapshot][solve]; null where a degree is not recorded.
  std::vector<std::vector<std::vector<SolveTask*>>> methods;
  /// Tasks by [method plus one; 0: initial][refined degree]. Empty for methods that improved
  /// nothing.
  std::vector<std::vector<SolveTask*>> refined{};
  /// Tasks by [method plus one; 0: initial][further solution][degree]. Empty for methods that
  /// improved nothing.
  std::vector<std::vector<std::vector<SolveTask*>>> further{};
};

/// The numbers that a study has computed so far.
template <int dim, int spacedim = dim>
struct StudyData {
  const Study& study;
  std::vector<StudySolve> solves;
  KeptResults kept;
  std::string session{};  ///< its start (UTC)
  std::vector<PreparedMesh<dim, spacedim>> meshes{};
  /// [mesh][solution]; empty: the study solves none.
  std::vector<std::vector<ManufacturedSolution<spacedim>>> solutions{};
  std::vector<std::string> mesh_contents{};                  ///< of each mesh, see result_names.h
  std::vector<std::vector<Trajectory>> trajectories{};       ///< [mesh][method]
  std::vector<std::vector<std::string>> trajectory_names{};  ///< of the kept trajectories
  std::list<SolveJob> jobs{};    ///< addresses of jobs and tasks stay valid
  std::list<SolveTask> tasks{};  ///< by mesh, degree, job, record
  std::vector<MeshTasks> mesh_tasks{};

  /// Returns the coordinates of a record of a kept trajectory; in parts, of this rank's nodes.
  std::vector<Point<spacedim>> load_coordinates(std::size_t mesh, const std::string& trajectory,
                                                std::size_t record) const;
  /// Returns the coordinates of a task's mesh, before its cells are split (if they are).
  std::vector<Point<spacedim>> coordinates_of(const SolveTask& task) const;
  SolveKind kind_of(const SolveTask& task) const;
};

/// Makes the jobs and tasks of all trajectories. Tasks with kept results are done.
template <int dim, int spacedim>
void make_tasks(StudyData<dim, spacedim>& data);

/// Stores a task's solution and its seconds. Kept results are saved at the end of a job and about
/// every second.
void finish_task(SolveTask& task, SolutionRecord solution, double seconds,
                 std::vector<double> eigenvectors, const KeptResults& kept);

/// Returns rows for iterations.csv of all finished records, in the order of meshes, methods,
/// records and degrees. Safe while tasks are running.
template <int dim, int spacedim>
std::vector<IterationRow> finished_rows(const StudyData<dim, spacedim>& data);

/// Returns rows for summary.csv; all tasks must be done.
template <int dim, int spacedim>
std::vector<SummaryRow> summary_rows(const StudyData<dim, spacedim>& data);

/// Returns rows for refined.csv; all tasks must be done.
template <int dim, int spacedim>
std::vector<RefinedRow> refined_rows(const StudyData<dim, spacedim>& data);

/// Returns rows for solutions.csv; all tasks must be done.
template <int dim, int spacedim>
std::vector<SolutionRow> solution_rows(const StudyData<dim, spacedim>& data);

/// Returns rows for metrics.csv of all recorded meshes, in the order of meshes, methods, records
/// and metrics. Metrics that are defined on none of a mesh's cells are left out. Calls `watch`
/// between two meshes.
template <int dim, int spacedim>
std::vector<MetricRow> metric_rows(const StudyData<dim, spacedim>& data,
                                   const std::function<void()>& watch);

/// Returns the sessions that the results come from; all tasks must be done.
template <int dim, int spacedim>
std::vector<ResultSessions> sessions_of(const StudyData<dim, spacedim>& data);

/// Returns the names of the kept results that the study is made of.
template <int dim, int spacedim>
std::set<std::string> names_of_kept(const StudyData<dim, spacedim>& data);

/// Returns the path for a method's mesh, or for the mesh called `initial`.
std::filesystem::path mesh_path(const std::filesystem::path& out, const std::string& mesh,
                                const std::string& method, const std::string& extension);

/// Writes initial and resulting meshes with their fields, and the series if the study sets it. All
/// tasks must be done. Throws InputError.
template <int dim, int spacedim>
void write_meshes(const StudyData<dim, spacedim>& data, const std::filesystem::path& out);

}  // namespace smoothfem
