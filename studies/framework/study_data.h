#pragma once

#include <filesystem>
#include <list>
#include <vector>

#include "studies/framework/results.h"
#include "studies/framework/solve_queue.h"
#include "studies/framework/study_meshes.h"
#include "studies/framework/trajectory.h"

namespace smoothfem {

/// The finite element tasks of one mesh: those of the initial mesh, shared by all methods, and
/// those of each method's snapshots; one a degree in each list, none where the mesh is invalid.
struct MeshTasks {
  std::vector<SolveTask*> initial;
  std::vector<std::vector<std::vector<SolveTask*>>> methods;  ///< [method][snapshot][degree]
};

/// What a study has computed so far.
struct StudyData {
  const Study& study;
  std::vector<PreparedMesh> meshes{};
  std::optional<ManufacturedSolution> solution{};
  std::vector<std::vector<Trajectory>> trajectories{};  ///< [mesh][method]
  std::list<SolveTask> tasks{};                         ///< stay where they are
  std::vector<MeshTasks> mesh_tasks{};
};

/// Rows for iterations.csv of all records that are done, in the order of meshes, methods, records
/// and degrees. Safe while tasks are under way.
std::vector<IterationRow> finished_rows(const StudyData& data);

/// Rows for summary.csv; all tasks must be done.
std::vector<SummaryRow> summary_rows(const StudyData& data);

/// Where a method's mesh, or the mesh called `initial`, is written.
std::filesystem::path mesh_path(const std::filesystem::path& out, const std::string& mesh,
                                const std::string& method, const std::string& extension);

/// Initial and resulting meshes with their fields, and the series if the study asks for them; all
/// tasks must be done. Throws InputError.
void write_meshes(const StudyData& data, const std::filesystem::path& out);

}  // namespace smoothfem
