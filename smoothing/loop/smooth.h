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

/// One iteration, as passed to observers.
struct IterationRecord {
  std::size_t record = 0;        ///< 0 for the initial mesh, then one more for each call
  std::string stage;             ///< smoother that ran; "initial" for record 0
  std::size_t iteration = 0;     ///< within the stage, in the method's own count
  double smoothing_seconds = 0;  ///< of the stages' main loops so far, without the observers' time
  double preparation_seconds = 0;      ///< before them: reordering, tables, the initial quality
  std::optional<double> wall_seconds;  ///< see StepReport
  MeshQuality quality;
  /// Number of cells that the step made invalid, before nodes were reset; only from methods that
  /// reset nodes.
  std::optional<std::size_t> n_made_invalid;
  std::size_t n_reset = 0;
  /// Cost of solves so far, for methods that need a problem. Its time is part of smoothing_seconds.
  std::optional<SolveEffort> solves = {};
};

/// Receives the numbers and the mesh of every iteration and of the initial mesh. Its time does not
/// count as smoothing time. If it throws, the run ends; the caller's mesh is then one of those the
/// observer has seen.
template <int dim, int spacedim = dim>
using Observer = std::function<void(const IterationRecord&, const Mesh<dim, spacedim>&)>;

struct StageResult {
  std::string name;
  std::size_t iterations = 0;    ///< in the method's own count
  std::string why_stopped;       ///< a clause without a full stop
  std::size_t n_last_reset = 0;  ///< nodes (or elements) that were reset in the last iteration
};

/// What became of the midside nodes of a mesh of second order (midside_placement.h).
struct MidsideReport {
  std::size_t n_repaired = 0;             ///< cells that were invalid before and are not any more
  std::size_t n_relaxed = 0;              ///< nodes moved for that towards their straight places
  std::size_t n_relaxed_on_boundary = 0;  ///< of these, nodes of the boundary and of interfaces
  std::size_t n_bent = 0;   ///< nodes inside that keep a part of their initial curvature
  std::size_t n_reset = 0;  ///< corners that went back to their initial places
};

struct SmoothingResult {
  std::vector<StageResult> stages;
  double smoothing_seconds = 0.0;    ///< of the stages' main loops (thesis, Section 5.2.1)
  double preparation_seconds = 0.0;  ///< before each main loop: reordering, tables, qualities
  MeshQuality quality;               ///< of the resulting mesh
  std::size_t result_record = 0;     ///< the record whose mesh is the result
  std::size_t n_floor_reset = 0;     ///< nodes that Method::floor has reset
  std::size_t n_floor_invalid = 0;   ///< invalid cells before that
  MidsideReport midside = {};        ///< of meshes of second order

  /// Returns the iterations as in the thesis' tables, one number for each stage: "40/2800".
  std::string iterations_text() const;
};

/// Smooths a mesh in place by the stages of a method; each starts from the result of the previous
/// one. Planar, volume and surface meshes; nodes of the last stay on their initial surface (thesis,
/// Section 5.1.2).
///
/// This function does what all methods share (thesis, Chapter 4): it resets the nodes of invalid
/// cells, keeps the best mesh, stops and measures times. It also reorders large meshes for memory
/// locality; the caller and the observer see the original order. Results are bitwise identical for
/// every number of threads.
///
/// In meshes of second order the method moves the corners, and midside nodes follow, or it moves
/// all nodes (SmootherTraits::moves_midside_nodes, smooth_second_order.h).
///
/// Throws InputError if the method needs a valid mesh and `mesh` is invalid. Throws it also if the
/// method cannot keep the constraints of the mesh, or if it needs a problem and has none. After any
/// exception `mesh` is in the state of the last iteration.
template <int dim, int spacedim>
SmoothingResult smooth(Mesh<dim, spacedim>& mesh, Method<dim, spacedim>& method,
                       const std::type_identity_t<Observer<dim, spacedim>>& observer = {});

}  // namespace smoothfem
