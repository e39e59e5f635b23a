#include "studies/framework/study_data.h"

#include "meshes/io/mesh_file.h"
#include "meshes/io/vtu_series.h"

namespace smoothfem {

namespace {

using Tasks = std::vector<SolveTask*>;

/// What a row says about finite elements: one entry a degree whose task is done, or the reason why
/// there are no numbers.
struct Outcome {
  int degree = 0;
  std::optional<SolutionRecord> solved{};
  std::string status{};
};

std::vector<Outcome> outcomes(const Study& study, const Tasks& tasks, bool invalid) {
  if (study.degrees.empty()) return {{.status = invalid ? "invalid mesh" : "not solved"}};
  std::vector<Outcome> result;
  for (std::size_t d = 0; d < study.degrees.size(); ++d) {
    const int degree = study.degrees[d];
    if (invalid)
      result.push_back({.degree = degree, .status = "invalid mesh"});
    else if (tasks[d]->done)
      result.push_back({degree, tasks[d]->record, tasks[d]->record.status});
  }
  return result;
}

void append_rows(const StudyData& data, std::size_t mesh, std::size_t method, std::size_t record,
                 const Tasks& tasks, std::vector<IterationRow>& rows) {
  const IterationRecord& iteration = data.trajectories[mesh][method].records[record];
  for (auto& outcome : outcomes(data.study, tasks, iteration.quality.n_invalid > 0))
    rows.push_back({data.meshes[mesh].description.name, data.study.methods[method].name, iteration,
                    outcome.degree, std::move(outcome.solved), std::move(outcome.status)});
}

void append_summary(const Study& study, SummaryRow row, const Tasks& tasks,
                    std::vector<SummaryRow>& rows) {
  for (auto& outcome : outcomes(study, tasks, row.quality.n_invalid > 0)) {
    row.degree = outcome.degree;
    row.solved = std::move(outcome.solved);
    row.status = std::move(outcome.status);
    rows.push_back(row);
  }
}

/// A method's resulting mesh and its tasks: those of the initial mesh if it improved nothing.
struct MethodResult {
  PlanarMesh mesh;
  const Tasks& tasks;
};

MethodResult method_result(const StudyData& data, std::size_t mesh, std::size_t method) {
  const auto& trajectory = data.trajectories[mesh][method];
  for (std::size_t s = 0; s < trajectory.snapshots.size(); ++s)
    if (trajectory.snapshots[s].record == trajectory.result_record)
      return {{data.meshes[mesh].mesh.shared_topology(), trajectory.snapshots[s].coordinates},
              data.mesh_tasks[mesh].methods[method][s]};
  return {data.meshes[mesh].mesh, data.mesh_tasks[mesh].initial};
}

MeshFields fields_of(const StudyData& data, const PlanarMesh& mesh, const Tasks& tasks) {
  MeshFields fields;
  fields.cell["mean_ratio"] = cell_mean_ratios(mesh);
  auto& exact = fields.point["exact_solution"];
  for (const auto& p : mesh.coordinates()) exact.push_back(data.solution->value(p));
  for (std::size_t d = 0; d < tasks.size(); ++d)
    fields.point["nodal_error_d" + std::to_string(data.study.degrees[d])] = tasks[d]->nodal_errors;
  return fields;
}

void write_series(const StudyData& data, std::size_t m, std::size_t k,
                  const std::filesystem::path& out) {
  const PreparedMesh& prepared = data.meshes[m];
  VtuSeries series(mesh_path(out, prepared.description.name, data.study.methods[k].name, ".pvd"));
  series.add(0.0, prepared.mesh, fields_of(data, prepared.mesh, data.mesh_tasks[m].initial));
  const auto& snapshots = data.trajectories[m][k].snapshots;
  for (std::size_t s = 0; s < snapshots.size(); ++s) {
    const PlanarMesh mesh(prepared.mesh.shared_topology(), snapshots[s].coordinates);
    series.add(static_cast<double>(snapshots[s].record), mesh,
               fields_of(data, mesh, data.mesh_tasks[m].methods[k][s]));
  }
}

}  // namespace

std::vector<IterationRow> finished_rows(const StudyData& data) {
  std::vector<IterationRow> rows;
  for (std::size_t m = 0; m < data.mesh_tasks.size(); ++m)
    for (std::size_t k = 0; k < data.study.methods.size(); ++k) {
      append_rows(data, m, k, 0, data.mesh_tasks[m].initial, rows);
      const auto& snapshots = data.trajectories[m][k].snapshots;
      for (std::size_t s = 0; s < snapshots.size(); ++s)
        append_rows(data, m, k, snapshots[s].record, data.mesh_tasks[m].methods[k][s], rows);
    }
  return rows;
}

std::vector<SummaryRow> summary_rows(const StudyData& data) {
  std::vector<SummaryRow> rows;
  for (std::size_t m = 0; m < data.meshes.size(); ++m) {
    const std::string& name = data.meshes[m].description.name;
    append_summary(data.study,
                   {.mesh = name, .method = "initial", .quality = data.meshes[m].quality},
                   data.mesh_tasks[m].initial, rows);
    for (std::size_t k = 0; k < data.study.methods.size(); ++k) {
      const auto& trajectory = data.trajectories[m][k];
      append_summary(data.study,
                     {.mesh = name,
                      .method = data.study.methods[k].name,
                      .iterations = trajectory.iterations_text,
                      .smoothing_seconds = trajectory.smoothing_seconds,
                      .quality = trajectory.quality},
                     method_result(data, m, k).tasks, rows);
    }
  }
  return rows;
}

std::filesystem::path mesh_path(const std::filesystem::path& out, const std::string& mesh,
                                const std::string& method, const std::string& extension) {
  return out / "meshes" / (mesh + "_" + method + extension);
}

void write_meshes(const StudyData& data, const std::filesystem::path& out) {
  for (std::size_t m = 0; m < data.meshes.size(); ++m) {
    const PreparedMesh& prepared = data.meshes[m];
    const std::string& name = prepared.description.name;
    write_mesh(mesh_path(out, name, "initial", ".vtu"), prepared.mesh,
               fields_of(data, prepared.mesh, data.mesh_tasks[m].initial));
    for (std::size_t k = 0; k < data.study.methods.size(); ++k) {
      const MethodResult result = method_result(data, m, k);
      write_mesh(mesh_path(out, name, data.study.methods[k].name, ".vtu"), result.mesh,
                 fields_of(data, result.mesh, result.tasks));
      if (data.study.write_series) write_series(data, m, k, out);
    }
  }
}

}  // namespace smoothfem
