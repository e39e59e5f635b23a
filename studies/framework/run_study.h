#pragma once

#include <atomic>
#include <filesystem>

#include "studies/framework/study.h"

namespace smoothfem {

struct StudyOptions {
  std::filesystem::path out;       ///< folder of the results; made if it is not there
  std::filesystem::path mesh_dir;  ///< folder of published meshes; empty: generate
  bool quick = false;              ///< noted in the provenance; read_study has applied it
  bool quiet = false;
  unsigned int n_threads = 0;  ///< for the finite elements; 0: all cores
  /// Set from outside to stop: the rows finished so far are written and the process ends with 130.
  const std::atomic<bool>* interrupted = nullptr;
};

/// Runs a study: meshes, then smoothing (one method at a time on one thread, nothing else running),
/// then a finite element record for every iteration (all cores), and writes iterations.csv,
/// summary.csv, thresholds.csv, provenance.json and the resulting meshes. Every file appears in one
/// piece; iterations.csv is written anew every few seconds with the rows finished so far. Numbers
/// do not depend on n_threads. Throws InputError.
void run_study(const Study& study, const StudyOptions& options);

}  // namespace smoothfem
