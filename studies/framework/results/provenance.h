// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "studies/framework/results/mesh_facts.h"

namespace smoothfem {

/// The number of threads and processes of a run.
struct ProcessorUse {
  unsigned int smoothing_threads = 1, finite_element_threads = 1;
  int n_ranks = 1;
};

/// The sessions that the results of a method on a mesh come from, by their start (UTC).
struct ResultSessions {
  std::string mesh, method;  ///< method: "initial" for the initial mesh
  std::string smoothed;      ///< session of the smoothing times; empty: not smoothed
  /// Sessions of the solves, by the degree of Poisson's equation, or by another solver's label and
  /// degree.
  std::map<std::string, std::string> solved;
};

/// The problem -div(A grad u) = f whose solution is prescribed, as text.
struct ProblemFacts {
  struct Solution {
    std::string label;  ///< empty: the study has one solution
    std::string u, a;
  };
  std::vector<Solution> solutions;
  std::vector<std::string> natural;  ///< groups of the boundary with natural conditions
  std::string load;                  ///< "nodal" or "quadrature"
  std::string geometry{};  ///< "curved" or "straight"; empty: no mesh has cells of second order
};

/// The content of provenance.json, except facts of the program and the machine.
struct RunFacts {
  const StudyHeader& study;
  ProcessorUse processors;
  std::string status;                     ///< "running", "interrupted" or "complete"
  std::string started;                    ///< of this session
  std::map<std::string, double> seconds;  ///< time split of this session
  std::string earlier_sessions;  ///< those of an earlier provenance of this run; empty: none
  MeshDimensions dimensions{};
  std::vector<MeshFacts> meshes{};
  std::vector<StudyMethod> methods{};  ///< for meshes of these dimensions
  std::vector<StudySolver> solvers{};  ///< in addition to Poisson's
  std::string shard{};                 ///< of a collection, for example "3/10"; empty: all
  std::map<std::string, std::string> members{};  ///< member -> mesh, of all shards
  ProblemFacts problem{};                        ///< without solutions if nothing is solved
  std::vector<ResultSessions> results{};         ///< of a complete run
  std::set<std::string> kept{};                  ///< names of the kept results of a complete run
};

/// Returns the text of provenance.json: commit, compiler, versions, machine, seeds, parameters in
/// force, and SHA-256 of every initial mesh (of its file in `meshes/`).
/// It also has the time split of each session that has worked on the results, and of all sessions
/// together.
std::string provenance_json(const RunFacts& facts);

/// The provenance that an earlier run has left in its folder.
struct EarlierRun {
  std::string status;
  std::string commit;
  std::string sessions;                         ///< for RunFacts
  std::map<std::string, std::string> settings;  ///< everything that determines the rows
  std::string written;                          ///< when (UTC)
  std::map<std::string, std::string> meshes;    ///< path below the folder -> SHA-256
  std::set<std::string> kept;                   ///< names of the kept results
};
/// Reads a provenance. The status is empty if the file does not exist. Throws InputError if it is
/// not a provenance.
EarlierRun read_provenance(const std::filesystem::path& path);

/// Returns the settings of this run, to compare with EarlierRun::settings. Without `meshes`, they
/// lack the sources of meshes and the files of methods.
std::map<std::string, std::string> settings_of(const StudyHeader& study,
                                               const std::vector<MeshFacts>& meshes,
                                               const std::vector<StudyMethod>& methods,
                                               const std::vector<StudySolver>& solvers = {});

/// Returns the present time (UTC) in the format of provenance.json.
std::string now_utc();

/// Returns the commit that this program was built from.
std::string program_commit();

/// Returns the version of each library.
std::map<std::string, std::string> library_versions();

}  // namespace smoothfem
