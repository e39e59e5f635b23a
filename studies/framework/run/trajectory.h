// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "smoothing/loop/smooth.h"
#include "smoothing/quality/warpage.h"
#include "studies/framework/definition/study.h"

namespace smoothfem {

/// Everything that smoothing one mesh by one method went through: the numbers of every iteration,
/// and which of them finite elements will be solved at.
struct Trajectory {
  std::vector<IterationRecord> records;  ///< the initial mesh first
  std::vector<std::size_t> snapshots;  ///< ascending indices into records, without the initial mesh
  std::size_t result_record = 0;       ///< whose mesh is the method's result
  std::string iterations_text;         ///< "40/2800"
  double smoothing_seconds = 0.0;      ///< of the whole run
  double preparation_seconds = 0.0;    ///< the same
  std::optional<double> wall_seconds;  ///< of the result, see StepReport
  MeshQuality quality;                 ///< of the result
  std::vector<CellsBelow> cells_below;          ///< of the result
  MeshWarpage warpage;                          ///< of the result; planar meshes: none
  std::vector<MeshWarpage> warpage_of_records;  ///< one per record, or empty
  double peak_memory_gib = 0.0;  ///< of the process, the study's other meshes included
  /// Why the method failed; empty if it did not. Its result is then the initial mesh, and the
  /// records are those before.
  std::string failure;
};

/// Warpage of the quadrilateral faces of a volume mesh; others have none.
template <int dim, int spacedim>
MeshWarpage warpage_of(const Mesh<dim, spacedim>& mesh);

/// Stores the mesh of a record.
template <int spacedim>
using KeepSnapshot =
    std::function<void(std::size_t record, std::span<const Point<spacedim>> coordinates)>;

/// Sees every iteration of every run, between two of them.
using WatchIteration = std::function<void(const IterationRecord&)>;

/// Runs a method timing_runs times on copies of the mesh and keeps the median of the accumulated
/// times of each record; the meshes are the same every time. Snapshots: every k-th record of each
/// stage, the result and the last, as the study says, or (only_results) the result and the last;
/// `keep` gets their meshes in any order, and
/// may get others too. A study that neither solves nor writes series nor metrics needs the result's
/// mesh only: then `keep` gets no other. What `keep` or `watch` throw ends it; a method that fails
/// is a trajectory with a `failure`. problem: for methods that need one; null otherwise. folders:
/// of the method's files.
template <int dim, int spacedim>
Trajectory record_trajectory(const Mesh<dim, spacedim>& mesh, const StudyMethod& method,
                             const Study& study, bool only_results,
                             const std::shared_ptr<const Problem<spacedim>>& problem,
                             const SmootherFolders& folders,
                             const std::type_identity_t<KeepSnapshot<spacedim>>& keep,
                             const WatchIteration& watch);

}  // namespace smoothfem
