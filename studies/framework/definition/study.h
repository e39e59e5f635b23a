// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fem/poisson_solver.h"
#include "fem/solvers/mesh_solver.h"
#include "meshes/distortion/distort.h"
#include "meshes/domains/catalogue.h"
#include "meshes/metrics/metric.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/quality/cell_targets.h"
#include "smoothing/surface/sliding_boundary.h"
#include "studies/framework/definition/included_files.h"
#include "studies/framework/definition/study_header.h"

namespace smoothfem {

/// One of a study's meshes: read from a file or generated, and distorted if asked for.
struct StudyMesh {
  std::string name;            ///< label in results: letters, digits, '.', '_', '-'
  std::string title;           ///< in tables and figures
  std::filesystem::path file;  ///< empty: generate
  std::string domain;          ///< which domain to generate
  std::string elements;        ///< of the generated mesh; empty: the domain's default
  std::string algorithm{};     ///< of the mesh generator; empty: the domain's default
  double eps = 0.0;            ///< DomainParameters::eps; 0: the domain's default
  int order = 1;               ///< of a generated mesh: 2 has nodes on the true boundary
  bool untangle = false;       ///< make a tangled mesh of a file valid first
  /// Name of a file in the folder of --mesh-dir, in place of `file` or `domain`. It is not
  /// distorted, because published meshes are already distorted.
  std::string published_file;
  double edge_scale = 1.0;         ///< of a generated mesh, times that of the study
  double distort_to_q_mean = 0.0;  ///< 0: not distorted
  double distort_within = 0.0;     ///< relative radius instead of a quality; 0: not distorted by it
  DistortionKind distortion = DistortionKind::worst_candidate;
  int distortion_candidates = 10;  ///< see DistortionParameters
  int distortion_sweeps = 1;
  double distortion_least_quality = 0.0;
  std::uint64_t seed = 1;
  std::string repeats{};  ///< the mesh that this one repeats with another seed; or empty
};

/// True if a mesh is distorted after it has been read or generated.
inline bool is_distorted(const StudyMesh& mesh) {
  return mesh.distort_to_q_mean > 0.0 || mesh.distort_within > 0.0;
}

/// Returns what the domain of a generated mesh gets.
inline DomainParameters parameters_of(const StudyMesh& mesh, double edge_scale) {
  return {.elements = mesh.elements,
          .edge_scale = edge_scale,
          .seed = mesh.seed,
          .algorithm = mesh.algorithm,
          .eps = mesh.eps == 0.0 ? std::nullopt : std::optional(mesh.eps)};
}

/// A file of a method or a solver that is not part of this program.
struct CodeFile {
  std::string name, sha256;
};

struct StudyMethod {
  std::string name;   ///< label in results
  std::string type;   ///< registered method, or method in a file, as in the study file
  std::string title;  ///< in tables and figures
  int threads = 0;    ///< 0: that of StudyOptions
  /// Labels of the solutions that its mesh is smoothed for, with equal weight, or that of one
  /// solver; empty: the first solution.
  std::vector<std::string> smooth_for{};
  InterfaceRule interfaces = InterfaceRule::fixed;
  std::optional<TargetKind> target{};  ///< taken from the initial mesh; nothing: regular cells
  std::vector<std::pair<std::string, std::string>> settings;  ///< parameters that are not default
  std::filesystem::path folder{};  ///< of the study file, which a method's file is relative to
  bool is_stand_in = false;        ///< read by OnlyLook: without its code it cannot smooth
  std::vector<CodeFile> files{};   ///< programs, scripts, plugins: filled when the study runs
  std::string version{};           ///< that the program reports

  /// The method with its settings.
  template <int dim, int spacedim = dim>
  Method<dim, spacedim> make() const;

  /// What the method takes from the solution that it moves nodes by.
  ProblemUse problem_use(MeshDimensions dimensions) const;
  /// True if the method moves nodes by the solution of the study's problem.
  bool needs_problem(MeshDimensions dimensions) const;
};

/// "FILE:LINE" of keys, for messages.
using KeyLines = std::map<std::string, std::string>;

/// The manufactured solution: a name, one formula, or expressions of all parts.
struct StudySolution {
  std::string name;  ///< "expression": given by the other fields
  std::string value, gradient, load;
  std::string u;                              ///< instead of value, gradient and load
  std::string diffusivity;                    ///< empty: the identity
  std::string label{};                        ///< in results; empty: the study has one solution
  std::vector<GroupDiffusivity> of_groups{};  ///< of groups of cells
  KeyLines lines{};                           ///< of its keys

  bool is_piecewise_by_tag() const { return diffusivity == "piecewise by tag"; }
  /// True if the diffusivity is that of the cells' groups, not of the position.
  bool has_materials() const { return is_piecewise_by_tag() || !of_groups.empty(); }
};

/// The label of the program's own solver for Poisson's equation in the list 'solvers'.
inline constexpr const char* poisson_label = "poisson";

/// A solver whose numbers are recorded in addition to those of Poisson's equation.
struct StudySolver {
  struct Keyed {
    std::string parameter, name, value;  ///< for example "E group", "steel", "210e9"
  };

  std::string label;           ///< in results: its columns are LABEL.NUMBER
  std::string type;            ///< registered solver, or solver in a file, as in the study file
  std::string title;           ///< in tables and figures
  std::vector<int> degrees{};  ///< of its finite elements; empty: it has none
  SolverTraits traits{};
  std::vector<std::pair<std::string, std::string>> settings{};  ///< parameters, not default
  std::vector<Keyed> keyed{};                                   ///< see MeshSolver
  std::filesystem::path folder{};                               ///< of the study file
  std::vector<CodeFile> files{};  ///< programs, scripts, plugins: filled when the study runs
  std::string version{};          ///< that the program reports

  /// The solver with its settings.
  template <int dim>
  std::unique_ptr<MeshSolver<dim>> make() const;
};

/// A solve of every recorded mesh: a solver with one of its degrees.
struct StudySolve {
  const StudySolver* solver;  ///< null: the program's own for Poisson's equation
  int degree;                 ///< 0: the solver has none
};

/// Settings for error thresholds (thesis, Table 6.4).
struct StudyThresholds {
  std::string reference;  ///< method whose smallest errors set the thresholds; empty: no thresholds
  double margin = 0.05;   ///< thresholds are the smallest errors increased by this fraction
};

/// The iterations at which finite elements are solved.
struct RecordEvery {
  int default_interval = 1;           ///< every k-th iteration of a method
  std::map<std::string, int> stages;  ///< by name: every k-th iteration of this stage instead
  /// After n_before_growth records, the number of intervals between records grows by this factor.
  double growth = 1.0;
  static constexpr std::size_t n_before_growth = 20;
};

/// A study as data: meshes, methods, problem and recorded numbers.
struct Study {
  StudyHeader header;
  std::filesystem::path folder{};  ///< of its file: other names are relative to it
  MeshDimensions dimensions;
  std::vector<StudyMesh> meshes;
  std::vector<StudyMethod> methods;
  std::vector<int> degrees;          ///< of Poisson's equation; empty: it is not solved
  std::vector<int> refined_degrees;  ///< of these: initial and resulting meshes once more, refined
  /// Of these: solved at all records; the others at initial, resulting and last meshes. Empty: all.
  std::vector<int> record_degrees;
  StudySolution solution;  ///< of the records
  /// Solutions that are also solved on initial and resulting meshes, and that methods may smooth
  /// for.
  std::vector<StudySolution> further_solutions{};
  std::vector<StudySolver> solvers{};     ///< in addition to Poisson's
  PoissonOptions finite_elements;         ///< its degree and its ties are not used
  KeyLines natural_lines{};               ///< of 'natural', and of its groups
  bool constrain_hanging_nodes = false;   ///< otherwise meshes with hanging nodes are refused
  bool constrain_periodic_nodes = false;  ///< otherwise u is given on periodic boundaries
  StudyThresholds thresholds;
  bool only_results_of_seeds = false;  ///< of StudyMesh::repeats: initial, resulting, last meshes
  RecordEvery record_every;     ///< also always: initial, resulting and last mesh of each method
  int timing_runs = 1;          ///< smoothing times are medians over this many runs
  double edge_scale = 1.0;      ///< factor of the edge lengths of generated meshes
  bool record_warpage = false;  ///< of every iteration, not only of initial and resulting meshes
  std::vector<double> count_below;     ///< mean ratios below which cells are counted
  std::vector<const Metric*> metrics;  ///< of every recorded mesh, for metrics.csv
  bool write_series = false;           ///< a VTU series for each mesh and method
  bool write_meshes = true;            ///< the resulting meshes with their fields
  int refine = 0;                      ///< in parts: every cell is split this often into 2^dim
  bool in_parts = false;  ///< each process has a part of a mesh (distributed/), and none has all
};

/// True if only the results on this mesh are solved, not the records on the way.
inline bool is_of_results_only(const Study& study, const StudyMesh& mesh) {
  return study.only_results_of_seeds && !mesh.repeats.empty();
}

/// True if finite elements of this degree are solved at all records, as solvers without degrees (0)
/// are.
inline bool is_recorded(const Study& study, int degree) {
  const auto& chosen = study.record_degrees;
  return degree == 0 || chosen.empty() ||
         std::find(chosen.begin(), chosen.end(), degree) != chosen.end();
}

/// Returns the solver that a method's mesh is smoothed for; null: the method is smoothed for
/// solutions of Poisson's equation.
const StudySolver* solver_smoothed_for(const Study& study, const StudyMethod& method);

/// Returns the solves of every recorded mesh. Those of Poisson's equation are the first, in the
/// order of `degrees`.
std::vector<StudySolve> solves_of(const Study& study);

/// Returns the degrees of the rows of a recorded mesh, those of Poisson's equation first; only 0 if
/// no solver has degrees. Numbers of solvers without degrees are in all rows.
std::vector<int> row_degrees(const Study& study);

/// True if meshes of all records are needed, not only results.
inline bool keeps_all_records(const Study& study) {
  return !study.degrees.empty() || !study.solvers.empty() || study.write_series ||
         !study.metrics.empty();
}

/// True if some solver needs the study's solutions.
inline bool needs_solutions(const Study& study) {
  return !study.degrees.empty() ||
         std::any_of(study.solvers.begin(), study.solvers.end(),
                     [](const auto& solver) { return solver.traits.needs_solution; });
}

/// Returns all solutions of a study. The solution of the records is the first.
std::vector<const StudySolution*> solutions_of(const Study& study);

/// While one lives, this process reads studies without running code that they name: methods in
/// files and plugins. Such methods are stand-ins, whose parameters are not checked.
class OnlyLook {
 public:
  OnlyLook();
  ~OnlyLook();
  OnlyLook(const OnlyLook&) = delete;
  static bool is_on();
};

/// Reads a study from a parameter file (deal.II's ParameterHandler format). scale: applies the
/// subsection `scale NAME`; empty: no scale.
/// Throws InputError with file and line for unknown keys and bad values. For an unknown scale the
/// message names the study's scales.
Study read_study(const std::filesystem::path& file, const std::string& scale = {});
/// Reads a study from a text. Messages name the text's file, and other file names are relative to
/// it.
Study study_of_text(const StudyText& text, const std::string& scale = {});

/// Returns the options that settings "KEY=VALUE" make, with the keys of the subsection 'finite
/// elements'. Condition numbers are those of CG, unless set. Throws InputError.
PoissonOptions finite_element_options(const std::vector<std::string>& settings);

/// Returns a commented parameter file with every key and its default, for a mesh and a method named
/// LABEL.
std::string study_template();

}  // namespace smoothfem
