// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/kept/result_names.h"

#include <cstdio>
#include <type_traits>

#include "meshes/metrics/metric.h"
#include "smoothfem_results_version.h"
#include "smoothing/loop/method_scheme.h"
#include "smoothing/mesh/node_constraints.h"
#include "studies/framework/results/provenance.h"
#include "studies/framework/results/sha256.h"
#include "studies/framework/run/kept/kept_results.h"

namespace smoothfem {

namespace {

template <class T>
std::string sha256_of_bytes(const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  return sha256({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

/// The text of everything that determines a result, one line for each.
class Ingredients {
 public:
  void add(const std::string& what, const std::string& value) {
    // With its length, a value with line breaks is not taken for several.
    text_ += what + ' ' + std::to_string(value.size()) + ' ' + value + '\n';
  }
  void add(const std::string& what, double value) {
    char number[32];
    std::snprintf(number, sizeof(number), "%.17g", value);
    add(what, std::string(number));
  }
  template <class Integer, class = std::enable_if_t<std::is_integral_v<Integer>>>
  void add(const std::string& what, Integer value) {
    add(what, std::to_string(value));
  }
  template <class T>
  void add_bytes(const std::string& what, const std::vector<T>& values) {
    add(what, sha256_of_bytes(values));
  }
  void add_program() {
    add("sources", std::string(SMOOTHFEM_RESULTS_VERSION));
    for (const auto& [library, version] : library_versions()) add(library, version);
  }

  std::string digest() const { return sha256(text_); }
  /// Returns a name for files. 128 bits of the digest are enough.
  std::string name(const std::string& kind) const { return kind + "-" + digest().substr(0, 32); }

 private:
  std::string text_;
};

template <class T>
void add_rows(const std::string& what, const CompressedRows<T>& rows, Ingredients& made_of) {
  std::vector<std::size_t> ends;
  for (std::size_t i = 0; i < rows.size(); ++i) ends.push_back(rows.offset(i) + rows[i].size());
  made_of.add_bytes(what + " ends", ends);
  made_of.add_bytes(what, rows.entries());
}

void add_recipe(const StudyMesh& mesh, Ingredients& made_of) {
  made_of.add("domain", mesh.domain);
  made_of.add("elements", mesh.elements);
  made_of.add("algorithm", mesh.algorithm);
  made_of.add("edge scale", mesh.edge_scale);
  made_of.add("seed", mesh.seed);
  // Names of meshes without these stay the same.
  if (mesh.eps > 0.0) made_of.add("eps", mesh.eps);
  if (mesh.untangle) made_of.add("untangle", 1);
  if (mesh.order > 1) made_of.add("order", mesh.order);
  if (!is_distorted(mesh)) return;
  made_of.add("distort to", mesh.distort_to_q_mean);
  made_of.add("distort within", mesh.distort_within);
  made_of.add("distortion", static_cast<int>(mesh.distortion));
  made_of.add("candidates", mesh.distortion_candidates);
  made_of.add("sweeps", mesh.distortion_sweeps);
  made_of.add("least quality", mesh.distortion_least_quality);
}

void add_labels(const MeshLabels& labels, Ingredients& made_of) {
  made_of.add_bytes("cell tags", labels.cell_tags);
  add_rows("labelled facets", labels.facets, made_of);
  made_of.add_bytes("facet tags", labels.facet_tags);
  if (labels.midside) add_rows("midside nodes", labels.midside->of_cells, made_of);
  for (const auto& [key, name] : labels.names)
    made_of.add("group " + std::to_string(key.first) + " " + std::to_string(key.second), name);
  // A file that says nothing more is as good as none.
  static const FileContent nothing;
  const FileContent& content = labels.content ? *labels.content : nothing;
  made_of.add_bytes("cell entities", content.cell_entities);
  made_of.add_bytes("facet entities", content.facet_entities);
  for (const auto& [key, entity] : content.entities)
    made_of.add_bytes("entity " + std::to_string(key.first) + " " + std::to_string(key.second),
                      entity.groups);
  for (const auto& periodic : content.periodic) {
    made_of.add_bytes("partners", periodic.nodes);
    made_of.add_bytes("map", periodic.affine);
  }
}

void add_solution(const StudySolution& solution, Ingredients& made_of) {
  made_of.add("solution", solution.name);
  made_of.add("value", solution.value);
  made_of.add("gradient", solution.gradient);
  made_of.add("load", solution.load);
  made_of.add("u", solution.u);
  made_of.add("diffusivity", solution.diffusivity);
  for (const auto& of_group : solution.of_groups)
    made_of.add("diffusivity of " + of_group.group, of_group.formula);
}

/// Adds the options of all degrees and meshes.
void add_options(const PoissonOptions& options, Ingredients& made_of) {
  made_of.add("load", static_cast<int>(options.load));
  // Names of results with curved cells, and of meshes without any, stay the same.
  if (options.geometry == Geometry::straight) made_of.add("geometry", "straight");
  for (const auto& group : options.natural_groups) made_of.add("natural", group);
  made_of.add("quadrilateral points", options.tensor_points.quadrilateral);
  made_of.add("hexahedron points", options.tensor_points.hexahedron);
  made_of.add("tolerance", options.cg_tolerance);
  made_of.add("boundary in norm", options.boundary_in_norm);
  made_of.add("iterations per dof", options.max_cg_iterations_per_dof);
  made_of.add("seconds", options.max_cg_seconds);
  made_of.add("condition number", static_cast<int>(options.condition_number));
  made_of.add("jacobi", static_cast<int>(options.jacobi_cg));
  made_of.add("multigrid", static_cast<int>(options.multigrid_cg));
  made_of.add("best approximation", static_cast<int>(options.best_approximation));
}

/// Adds the method's parts and parameters, and the files of its code.
template <int dim, int spacedim>
void add_method(const StudyMethod& method, Ingredients& made_of) {
  auto made = method.make<dim, spacedim>();
  // The folder of a method's file is not part of the result; its content is.
  const auto in_file = method_in_file(method.type);
  made_of.add("type", in_file ? in_file->scheme + ":" + in_file->object : method.type);
  for (const auto& stage : made.stages) made_of.add("stage", std::string(stage->name()));
  for (const auto& parameter : made.parameters())
    made_of.add(parameter.name, value_text(parameter));
  for (const auto& file : method.files) made_of.add("file " + file.name, file.sha256);
  made_of.add("version", method.version);
  made_of.add("threads", method.threads);
  made_of.add("interfaces", static_cast<int>(method.interfaces));
  made_of.add("target", method.target ? static_cast<int>(*method.target) : -1);
}

/// Adds a solver with its parameters, and the files of its code.
void add_solver(const StudySolver& solver, Ingredients& made_of) {
  const auto in_file = method_in_file(solver.type);
  made_of.add("solver", in_file ? in_file->scheme + ":" + in_file->object : solver.type);
  for (const auto& [name, value] : solver.settings) made_of.add(name, value);
  for (const auto& [parameter, name, value] : solver.keyed)
    made_of.add(parameter + " " + name, value);
  for (const auto& file : solver.files) made_of.add("file " + file.name, file.sha256);
  made_of.add("version", solver.version);
}

/// Adds the problem that a method moves nodes by.
void add_problem(const StudyMethod& method, const Study& study, Ingredients& made_of) {
  if (!method.needs_problem(study.dimensions)) return;
  if (const StudySolver* solver = solver_smoothed_for(study, method)) {
    add_solver(*solver, made_of);
    if (solver->traits.needs_solution) add_solution(study.solution, made_of);
    return;
  }
  if (study.degrees.empty()) return;
  add_options(study.finite_elements, made_of);
  bool any = false;
  for (const StudySolution* solution : solutions_of(study))
    for (const auto& label : method.smooth_for)
      if (label == solution->label) {
        add_solution(*solution, made_of);
        any = true;
      }
  if (!any) add_solution(study.solution, made_of);
}

void add_ties(const NodeTies& ties, Ingredients& made_of) {
  for (const auto& tie : ties.nodes) {
    made_of.add("tied", tie.node);
    for (const auto& [node, weight] : tie.masters) {
      made_of.add("to", node);
      made_of.add("weight", weight);
    }
  }
  for (const auto& facet : ties.inner_facets) made_of.add_bytes("inner facet", facet);
}

}  // namespace

std::string kept_mesh_name(const StudyMesh& description, const std::string& source_sha256,
                           double edge_scale) {
  Ingredients made_of;
  made_of.add_program();
  made_of.add("file", source_sha256);
  made_of.add("edge scale of the study", edge_scale);
  add_recipe(description, made_of);
  return made_of.name("mesh");
}

template <int dim, int spacedim>
std::string mesh_content(const Mesh<dim, spacedim>& mesh, const MeshFacts& facts) {
  Ingredients made_of;
  const Topology& topology = mesh.topology();
  made_of.add("dimension", dim);
  made_of.add_bytes("coordinates", numbers_of<spacedim>(mesh.coordinates()));
  add_rows("cells", topology.cells(), made_of);
  made_of.add_bytes("fixed", topology.fixed_reasons());
  add_labels(topology.labels(), made_of);
  if (mesh.constraints() != nullptr) {  // by the surface as it was before the mesh was distorted
    made_of.add("file", facts.source_sha256);
    add_recipe(facts.description, made_of);
  }
  return made_of.digest();
}
template std::string mesh_content(const Mesh<2>&, const MeshFacts&);
template std::string mesh_content(const Mesh<3>&, const MeshFacts&);
template std::string mesh_content(const Mesh<2, 3>&, const MeshFacts&);

std::string trajectory_name(const std::string& mesh_content, const StudyMethod& method,
                            const Study& study, bool only_results, unsigned int threads) {
  Ingredients made_of;
  made_of.add_program();
  made_of.add("mesh", mesh_content);
  with_dimensions(study.dimensions,
                  [&]<int dim, int spacedim>() { add_method<dim, spacedim>(method, made_of); });
  add_problem(method, study, made_of);
  made_of.add("smoothing threads", threads);
  made_of.add("timing runs", study.timing_runs);
  made_of.add("every", study.record_every.default_interval);
  for (const auto& [stage, interval] : study.record_every.stages)
    made_of.add("every of " + stage, interval);
  made_of.add("growth", study.record_every.growth);
  made_of.add("only results", only_results);
  made_of.add("keeps all", keeps_all_records(study));
  made_of.add("warpage", study.record_warpage);
  for (const double threshold : study.count_below) made_of.add("below", threshold);
  return made_of.name("smoothed");
}

std::string content_of(const std::vector<double>& coordinates) {
  return sha256_of_bytes(coordinates);
}

std::string content_of(const Trajectory& trajectory,
                       const std::map<std::size_t, std::string>& contents) {
  Ingredients made_of;
  made_of.add("result", trajectory.result_record);
  for (const std::size_t record : trajectory.snapshots) {
    made_of.add("record", record);
    const auto content = contents.find(record);
    if (content != contents.end()) made_of.add("content", content->second);
  }
  return made_of.digest();
}

std::string solved_name(const SolvedFrom& from, const StudySolution& solution, const Study& study) {
  Ingredients made_of;
  made_of.add_program();
  made_of.add("mesh", from.mesh_content);
  made_of.add("trajectory", from.trajectory);
  made_of.add("degree", from.degree);
  made_of.add("refined", from.is_refined);
  made_of.add("further", from.is_further);
  if (from.solver != nullptr) {
    add_solver(*from.solver, made_of);
    if (from.solver->traits.needs_solution) add_solution(solution, made_of);
    if (from.ties != nullptr) add_ties(*from.ties, made_of);
    return made_of.name("solved");
  }
  made_of.add("series", study.write_series);
  add_options(study.finite_elements, made_of);
  add_solution(solution, made_of);
  if (from.ties != nullptr) add_ties(*from.ties, made_of);
  return made_of.name("solved");
}

std::string rows_digest(const Study& study, unsigned int smoothing_threads) {
  Ingredients made_of;
  made_of.add("study", study.header.name);
  for (const auto& method : study.methods) {
    made_of.add("method", method.name);
    made_of.add("smoothed", trajectory_name("", method, study, false, smoothing_threads));
  }
  for (const StudySolution* solution : solutions_of(study)) {
    made_of.add("label", solution->label);
    for (const int degree : study.degrees)
      made_of.add("solved", solved_name({.mesh_content = "", .trajectory = "", .degree = degree},
                                        *solution, study));
  }
  for (const auto& solver : study.solvers) {
    made_of.add("label", solver.label);
    for (const int degree : solver.degrees) made_of.add("degree", degree);
    add_solver(solver, made_of);
  }
  for (const int degree : study.refined_degrees) made_of.add("refined", degree);
  for (const Metric* metric : study.metrics) made_of.add("metric", metric->name);
  made_of.add("threshold", study.thresholds.reference);
  made_of.add("margin", study.thresholds.margin);
  made_of.add("hanging", study.constrain_hanging_nodes);
  made_of.add("periodic", study.constrain_periodic_nodes);
  made_of.add("meshes", study.write_meshes);
  return made_of.digest();
}

}  // namespace smoothfem
