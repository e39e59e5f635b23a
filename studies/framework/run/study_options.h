// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <string>
#include <thread>

#include "fem/ranks/ranks.h"
#include "studies/framework/definition/study.h"

namespace smoothfem {

/// The phase of a study after which a run ends. The next run resumes from there.
enum class RunUntil { meshes, smoothing, results };

/// Settings of a run, for studies of all kinds.
struct StudyOptions {
  std::filesystem::path out;       ///< folder of the results; made if it is not there
  std::filesystem::path mesh_dir;  ///< folder of published meshes; empty: generate
  bool force =
      false;  ///< start anew, without kept results; the folder of an earlier run is renamed
  bool retry_failed = false;  ///< also the members of a collection that have failed
  bool quiet = false;
  RunUntil until = RunUntil::results;  ///< of studies of smoothing methods
  std::filesystem::path kept{};  ///< folder of kept results; empty: `out`/kept, for this study only
  bool retime = false;           ///< smooth all meshes again, to measure all times in one session
  unsigned int keep = 1;         ///< number of earlier results that stay below `out`/earlier
  bool dry_run = false;          ///< only print the plan
  unsigned int n_threads = 0;    ///< for the finite elements of planar meshes; 0: all cores
  unsigned int smoothing_threads = 1;
  std::string shard{};   ///< "3/10": the third of ten parts of a collection; empty: all
  int task_socket = -1;  ///< for commands of another process of the same run; -1: none
  Ranks ranks{};         ///< that share the finite elements of volume meshes, or members
  /// Set by other code to stop the run. The finished rows are then written, and the process ends
  /// with exit code 130.
  const std::atomic<bool>* interrupted = nullptr;

  /// Returns a method's own number of threads, or that of all methods.
  unsigned int threads_of(const StudyMethod& method) const {
    return method.threads > 0 ? static_cast<unsigned int>(method.threads) : smoothing_threads;
  }

  /// Returns n_threads, or the number of cores.
  unsigned int threads() const {
    return n_threads > 0 ? n_threads : std::max(1U, std::thread::hardware_concurrency());
  }
};

}  // namespace smoothfem
