// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fem/poisson_solver.h"
#include "meshes/distortion/distort.h"
#include "meshes/metrics/metric.h"
#include "smoothing/loop/catalogue.h"
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
  /// File name looked for with --mesh-dir, in place of `file` or `domain`. It is taken as it is,
  /// not distorted: published meshes are already.
  std::string published_file;
  double edge_scale = 1.0;         ///< of a generated mesh, times that of the study
  double distort_to_q_mean = 0.0;  ///< 0: not distorted
  double distort_within = 0.0;     ///< relative radius instead of a quality; 0: not distorted by it
  DistortionKind distortion = DistortionKind::worst_candidate;
  int distortion_candidates = 10;  ///< see DistortionParameters
  int distortion_sweeps = 1;
  double distortion_least_quality = 0.0;
  std::uint64_t seed = 1;
  std::string repeats{};  ///< the mesh that this one is, with another seed; or empty
};

/// Whether a mesh is changed after it has been read or generated.
inline bool is_distorted(const StudyMesh& mesh) {
  return mesh.distort_to_q_mean > 0.0 || mesh.distort_within > 0.0;
}

/// A file that a method comes from, which is not part of this program.
struct MethodFile {
  std::string name, sha256;
};

struct StudyMethod {
  std::string name;   ///< label in results
  std::string type;   ///< registered method, or one in a file, as the study names it
  std::string title;  ///< in tables and figures
  int threads = 0;    ///< 0: as StudyOptions says
  /// Labels of the solutions that its mesh is smoothed for, all of them alike; empty: the first.
  std::vector<std::string> smooth_for{};
  std::vector<std::pair<std::string, std::string>> settings;  ///< parameters that are not default
  std::filesystem::path folder{};   ///< of the study file, which a method's file is relative to
  std::vector<MethodFile> files{};  ///< programs, scripts, plugins: filled when the study runs
  std::string version{};            ///< of the program, as it says

  /// The method with its settings.
  template <int dim, int spacedim = dim>
  Method<dim, spacedim> make() const;

  /// Whether it moves nodes by the solution of the study's problem.
  bool needs_problem(MeshDimensions dimensions) const;
};

/// Where the manufactured solution comes from: a name, one formula, or expressions of all parts.
struct StudySolution {
  std::string name;  ///< "expression": the others say it
  std::string value, gradient, load;
  std::string u;            ///< in place of the three
  std::string diffusivity;  ///< empty: the identity
  std::string label{};      ///< in results; empty: the study has one solution
};

/// When error thresholds count as reached (thesis, Table 6.4).
struct StudyThresholds {
  std::string reference;  ///< method whose least errors set the thresholds; empty: no thresholds
  double margin = 0.05;   ///< thresholds are the least errors increased by this fraction
};

/// At which iterations finite elements are solved.
struct RecordEvery {
  int default_interval = 1;           ///< every k-th iteration of a method
  std::map<std::string, int> stages;  ///< by name: every k-th iteration of this stage instead
};

/// A study as data: which meshes, which methods, which problem, what to record.
struct Study {
  StudyHeader header;
  std::filesystem::path folder{};  ///< of its file: other names are relative to it
  MeshDimensions dimensions;
  std::vector<StudyMesh> meshes;
  std::vector<StudyMethod> methods;
  std::vector<int> degrees;          ///< of the finite elements; empty: smoothing only
  std::vector<int> refined_degrees;  ///< of these: initial and resulting meshes once more, refined
  StudySolution solution;            ///< of the records
  /// Solved on initial and resulting meshes besides, and for methods to smooth for.
  std::vector<StudySolution> further_solutions{};
  PoissonOptions finite_elements;  ///< its degree is not used
  StudyThresholds thresholds;
  bool only_results_of_seeds = false;  ///< of StudyMesh::repeats: initial, resulting, last meshes
  RecordEvery record_every;     ///< initial and resulting mesh and the last of each method always
  int timing_runs = 1;          ///< smoothing times are medians over this many runs
  double edge_scale = 1.0;      ///< generated meshes: edges this much longer
  bool record_warpage = false;  ///< of every iteration, not only of initial and resulting meshes
  std::vector<double> count_below;     ///< mean ratios below which cells are counted
  std::vector<const Metric*> metrics;  ///< of every recorded mesh, for metrics.csv
  bool write_series = false;           ///< a VTU series for each mesh and method
  bool write_meshes = true;            ///< the resulting meshes with their fields
};

/// All solutions of a study, that of the records first.
std::vector<const StudySolution*> solutions_of(const Study& study);

/// Reads a study from a parameter file (deal.II's ParameterHandler format). scale: with the changes
/// of its subsection `scale NAME`; empty: none. Throws InputError with file and line for unknown
/// keys and bad values, and for a scale that the study does not have, naming those it has.
Study read_study(const std::filesystem::path& file, const std::string& scale = {});
/// The same for a text; its file is the one that messages name and other names are relative to.
Study study_of_text(const StudyText& text, const std::string& scale = {});

/// A commented parameter file with every key and its default, for the methods and meshes named.
std::string study_template();

}  // namespace smoothfem
