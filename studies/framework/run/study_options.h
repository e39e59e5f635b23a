// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <string>
#include <thread>

#include "fem/ranks/ranks.h"

namespace smoothfem {

/// After which of a study's phases a run ends; the next one goes on from there.
enum class RunUntil { meshes, smoothing, results };

/// How a study is run, whatever its kind.
struct StudyOptions {
  std::filesystem::path out;       ///< folder of the results; made if it is not there
  std::filesystem::path mesh_dir;  ///< folder of published meshes; empty: generate
  bool force = false;              ///< start anew; the folder of an earlier run is renamed
  bool quiet = false;
  RunUntil until = RunUntil::results;     ///< of studies of smoothing methods
  bool initial_meshes_are_there = false;  ///< in `out`, though no run has begun there
  bool dry_run = false;                   ///< say what would be done, and do nothing
  unsigned int n_threads = 0;  ///< for the finite elements of planar meshes; 0: all cores
  unsigned int smoothing_threads = 1;
  std::string shard{};   ///< "3/10": of a collection the third part of ten only; empty: all
  int task_socket = -1;  ///< where another process of the same run says what to do; -1: none does
  Ranks ranks{};         ///< that share the finite elements of volume meshes, or members
  /// Set from outside to stop: the rows finished so far are written and the process ends with 130.
  const std::atomic<bool>* interrupted = nullptr;

  /// n_threads, or as many as there are cores.
  unsigned int threads() const {
    return n_threads > 0 ? n_threads : std::max(1U, std::thread::hardware_concurrency());
  }
};

}  // namespace smoothfem
