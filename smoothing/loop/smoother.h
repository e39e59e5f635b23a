// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "smoothing/loop/problem.h"
#include "smoothing/loop/stopping.h"
#include "smoothing/mesh/mesh.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {

/// What a smoother sees and changes.
template <int dim, int spacedim = dim>
struct SmoothingState {
  Mesh<dim, spacedim> mesh;
  /// Quality of each cell of `mesh` at the beginning of a step. Up to date for every smoother but
  /// those with QualityUse::none, which must not look at it.
  std::vector<double> cell_quality;
  /// Of the mesh that the method, not just this stage, began with.
  MeshQuality initial_quality = {};
  /// Of the problem whose solution the method needs (MethodInfo::needs_problem); otherwise null.
  ProblemSolver<spacedim>* solver = nullptr;
};

/// Who evaluates the quality of the cells, and so whether its cost is part of the method's time.
enum class QualityUse {
  none,  ///< the method knows no mean ratio, and nobody puts invalid cells back
  loop,  ///< after each step the loop puts nodes of invalid cells back and evaluates the quality
  smoother,  ///< the step keeps all cells valid and leaves cell_quality up to date
};

/// The mesh a method ends with.
enum class ResultMesh {
  last,
  best_q_mean,
  best_q_star_min,
  best_score  ///< as the steps report it
};

/// What a smoother is.
struct SmootherTraits {
  QualityUse quality_use = QualityUse::loop;
  ResultMesh result = ResultMesh::best_q_mean;
  bool needs_valid_mesh = true;
  /// The step visits nodes one after the other, so that its result depends on their order: the mesh
  /// keeps the order it has.
  bool needs_node_order = false;
  /// The step puts nodes only where allowed_position (smoothing/mesh/node_constraints.h) has them,
  /// and, unless the quality is evaluated by the loop, where keeps_facet_bound holds; other methods
  /// do not take meshes with constraints.
  bool keeps_constraints = false;
};

/// What one step tells the loop.
struct StepReport {
  std::size_t n_counted = 1;      ///< iterations in the method's own count (100 for a cycle of 100)
  double max_displacement = 0.0;  ///< longest movement of a node; needed by that criterion only
  bool converged = false;         ///< see StoppingRule::Criterion
  /// Cells that were invalid before nodes were put back; of steps that put them back all at once.
  std::optional<std::size_t> n_made_invalid = {};
  std::size_t n_reset = 0;  ///< nodes (or elements) put back because a cell became invalid
  /// From steps that keep the quality up to date themselves: the quality of the mesh, or just its
  /// q*_min where the rest would take a look at every cell.
  std::optional<MeshQuality> quality = {};
  std::optional<double> q_star_min = {};
  double score = 0.0;  ///< of the mesh, for ResultMesh::best_score
  /// The nodes that the step has moved, where these are few; otherwise nothing. Valid until the
  /// next step.
  std::optional<std::span<const NodeIndex>> moved = {};
  /// The stage's time up to here, of steps that know it better than a clock around them: of another
  /// program, without its start and its files.
  std::optional<double> stage_seconds = {};
  /// Of the program run that this mesh comes from, from its start to its end.
  std::optional<double> wall_seconds = {};
};

/// A method has failed on a mesh, as programs may that are not this one: its row says why, and
/// studies go on with the others.
class SmootherFailure : public InputError {
 public:
  using InputError::InputError;
};

/// Where smoothers that use files find and leave them.
struct SmootherFolders {
  std::filesystem::path given = ".";  ///< names of files that users give are relative to this one
  std::filesystem::path log = {};     ///< file for what another program prints; empty: none
};

/// Where a smoother comes from that is not part of this program: for the provenance.
struct SmootherOrigin {
  std::vector<std::filesystem::path> files = {};  ///< programs, scripts, libraries
  std::string version = {};                       ///< as it says itself; may be empty
};

/// One way to move the free nodes of a mesh. A new method is one file with a class template over
/// the dimension that derives from this one and registers itself (catalogue.h); the loop (smooth.h)
/// does everything that methods share. Steps may use several threads (parallel.h).
template <int dim, int spacedim = dim>
class Smoother {
 public:
  virtual ~Smoother() = default;

  /// Name of the stage in results, and the prefix of its parameters in methods of several stages.
  virtual std::string_view name() const = 0;
  virtual Parameters parameters() { return {}; }
  virtual SmootherTraits traits() const { return {}; }
  virtual StoppingRule stopping() const { return QualityGainStopping().rule(); }

  /// Called once before the first step; what depends on the topology alone belongs here.
  virtual void initialize(const SmoothingState<dim, spacedim>& /*state*/) {}

  /// Throws InputError where parameters do not go together; called when all are set.
  virtual void check_parameters() const {}

  /// Called before all others by whoever runs studies or commands.
  virtual void use_folders(const SmootherFolders& /*folders*/) {}

  /// Asked for when a study begins; may start a program to ask for its version.
  virtual SmootherOrigin origin() { return {}; }

  /// Score of the mesh given to initialize, for ResultMesh::best_score.
  virtual double initial_score() const { return 0.0; }

  /// Moves free nodes of state.mesh: one iteration. Fixed ones stay, unless users let them slide.
  virtual StepReport step(SmoothingState<dim, spacedim>& state) = 0;
};

}  // namespace smoothfem
