// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "smoothing/loop/smooth.h"
#include "smoothing/quality/warpage.h"
#include "studies/framework/definition/study.h"

namespace smoothfem {

/// The course of smoothing one mesh by one method: the numbers of every iteration, and the records
/// at which finite elements will be solved.
struct Trajectory {
  std::vector<IterationRecord> records;  ///< the initial mesh first
  std::vector<std::size_t> snapshots;  ///< ascending indices into records, without the initial mesh
  std::size_t result_record = 0;       ///< the record whose mesh is the method's result
  std::string iterations_text;         ///< "40/2800"
  double smoothing_seconds = 0.0;      ///< of the whole run
  double preparation_seconds = 0.0;    ///< of the whole run
  std::optional<double> wall_seconds;  ///< of the result, see StepReport
  MeshQuality quality;                 ///< of the result
  std::vector<CellsBelow> cells_below;          ///< of the result
  MeshWarpage warpage;                          ///< of the result; planar meshes: none
  std::vector<MeshWarpage> warpage_of_records;  ///< one per record, or empty
  double peak_memory_gib = 0.0;  ///< of the process, the study's other meshes included
  /// Why the method failed; empty if it did not. The result of a failed method is the initial mesh,
  /// and the records are those before the failure.
  std::string failure;
  std::string session{};  ///< start of the session that smoothed the mesh (UTC)
  /// SHA-256 of the snapshots and their coordinates; says what finite element records are made of.
  std::string content{};
};

/// Returns the warpage of a volume mesh's quadrilateral faces; empty for other meshes, and in
/// parts.
template <int dim, int spacedim>
MeshWarpage warpage_of(const Mesh<dim, spacedim>& mesh);

/// Stores the mesh of a record.
template <int spacedim>
using KeepSnapshot =
    std::function<void(std::size_t record, std::span<const Point<spacedim>> coordinates)>;

/// Function that is called at every iteration of every run.
using WatchIteration = std::function<void(const IterationRecord&)>;

/// Runs a method timing_runs times on copies of the mesh, and keeps the median times of each
/// record. The meshes are the same every time. In parts, each rank gets the times and the memory of
/// the rank that needs most.
/// Snapshots are every k-th record of each stage, the result and the last record, as the study
/// says. only_results: only the result and the last record.
/// keep: gets the snapshots' meshes in any order, and possibly others. If the study needs no
/// solves, series or metrics, it gets only the result's mesh.
/// Exceptions of `keep` and `watch` end the run. A method that fails gives a trajectory with a
/// `failure`.
/// problem: for methods that need one; otherwise null. folders: for the method's files.
template <int dim, int spacedim>
Trajectory record_trajectory(const Mesh<dim, spacedim>& mesh, const StudyMethod& method,
                             const Study& study, bool only_results,
                             const std::shared_ptr<const Problem<spacedim>>& problem,
                             const SmootherFolders& folders,
                             const std::type_identity_t<KeepSnapshot<spacedim>>& keep,
                             const WatchIteration& watch);

}  // namespace smoothfem
