// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "studies/framework/results/mesh_facts.h"

namespace smoothfem {

/// How a run uses the machine.
struct ProcessorUse {
  unsigned int smoothing_threads = 1, finite_element_threads = 1;
  int n_ranks = 1;
};

/// What provenance.json says besides what the program knows of itself and the machine.
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
};

/// provenance.json as text: commit, compiler, versions, machine, seeds, SHA-256 of every initial
/// mesh (of its file in `meshes/`), the parameters in force, and the time split, of each session
/// that has worked on the results and of all together.
std::string provenance_json(const RunFacts& facts);

/// What an earlier run has left in its folder.
struct EarlierRun {
  std::string status;
  std::string commit;
  std::string sessions;                         ///< for RunFacts
  std::map<std::string, std::string> settings;  ///< everything that determines the rows
  std::map<std::string, std::string> meshes;    ///< name -> SHA-256 of its file
};
/// Throws InputError if the file is not a provenance; an empty status if there is none.
EarlierRun read_provenance(const std::filesystem::path& path);

/// The same settings of this run; without `meshes` neither their sources nor the files of methods
/// are among them yet.
std::map<std::string, std::string> settings_of(const StudyHeader& study,
                                               const std::vector<MeshFacts>& meshes,
                                               const std::vector<StudyMethod>& methods);

/// The present time (UTC), as in provenance.json.
std::string now_utc();

/// The commit that this program was built from.
std::string program_commit();

/// Of each library its version.
std::map<std::string, std::string> library_versions();

}  // namespace smoothfem
