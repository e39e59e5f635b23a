// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/smoother.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {

/// One iteration as an observer sees it.
struct IterationRecord {
  std::size_t record = 0;        ///< 0 for the initial mesh, then one more for each call
  std::string stage;             ///< smoother that ran; "initial" for record 0
  std::size_t iteration = 0;     ///< within the stage, in the method's own count
  double smoothing_seconds = 0;  ///< of the stages' main loops so far, without the observers' time
  double preparation_seconds = 0;      ///< before them: reordering, tables, the initial quality
  std::optional<double> wall_seconds;  ///< see StepReport
  MeshQuality quality;
  /// Cells that the step made invalid, before nodes were put back; of methods that do that.
  std::optional<std::size_t> n_made_invalid;
  std::size_t n_reset = 0;
  /// So far, of methods that need a problem: its time is part of smoothing_seconds.
  std::optional<SolveEffort> solves = {};
};

/// Gets every iteration's numbers and mesh, the initial one included. Its time does not count as
/// smoothing time. An exception it throws ends the run; the caller's mesh is then one of those the
/// observer has seen.
template <int dim, int spacedim = dim>
using Observer = std::function<void(const IterationRecord&, const Mesh<dim, spacedim>&)>;

struct StageResult {
  std::string name;
  std::size_t iterations = 0;    ///< in the method's own count
  std::string why_stopped;       ///< a clause without a full stop
  std::size_t n_last_reset = 0;  ///< nodes (or elements) put back in the last iteration
};

struct SmoothingResult {
  std::vector<StageResult> stages;
  double smoothing_seconds = 0.0;    ///< of the stages' main loops (thesis, Section 5.2.1)
  double preparation_seconds = 0.0;  ///< of what comes before each: reordering, tables, qualities
  MeshQuality quality;               ///< of the resulting mesh
  std::size_t result_record = 0;     ///< the record whose mesh is the result

  /// As in the thesis' tables: "40/2800", one number a stage.
  std::string iterations_text() const;
};

/// Smooths a mesh in place by the stages of a method, one after the other, each from the result of
/// the one before. Owns what methods share: putting back the nodes of invalid cells, the best mesh,
/// stopping, timing (thesis, Chapter 4), and an order of large meshes that suits the memory: the
/// caller and the observer see their own. Deterministic: the same bits for every number of threads.
/// Throws InputError if the method needs a valid mesh and `mesh` is not, and if it cannot keep the
/// nodes of a mesh with constraints where they belong, or if it needs a problem and has none;
/// whatever is thrown, `mesh` is then as far as it came. Planar, volume and surface meshes; nodes
/// of the last stay on their initial surface (thesis, Section 5.1.2).
template <int dim, int spacedim>
SmoothingResult smooth(Mesh<dim, spacedim>& mesh, Method<dim, spacedim>& method,
                       const std::type_identity_t<Observer<dim, spacedim>>& observer = {});

}  // namespace smoothfem
