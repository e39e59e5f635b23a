#pragma once

#include <map>
#include <string>
#include <vector>

#include "studies/framework/run_study.h"
#include "studies/framework/study_meshes.h"

namespace smoothfem {

/// What provenance.json says besides what the program knows of itself and the machine.
struct RunFacts {
  const Study& study;
  const StudyOptions& options;
  const std::vector<PreparedMesh>& meshes;
  unsigned int n_threads;
  std::string status;                     ///< "running", "interrupted" or "complete"
  std::map<std::string, double> seconds;  ///< time split
};

/// provenance.json as text: commit, compiler, versions, machine, seeds, SHA-256 of every initial
/// mesh (of its polygonal text form in `meshes/`), effective parameters, time split.
std::string provenance_json(const RunFacts& facts);

/// One line a library: name and version, for the command line.
std::map<std::string, std::string> library_versions();

}  // namespace smoothfem
