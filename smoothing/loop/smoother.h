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

/// State that a smoother reads and changes.
template <int dim, int spacedim = dim>
struct SmoothingState {
  Mesh<dim, spacedim> mesh;
  /// Quality of each cell of `mesh` at the beginning of a step. Not up to date for smoothers with
  /// QualityUse::none, which must not read it.
  std::vector<double> cell_quality;
  /// Quality of the mesh at the start of the method, not only of this stage.
  MeshQuality initial_quality = {};
  /// Solver of the problem whose solution the method needs (MethodInfo::problem_use); otherwise
  /// null.
  ProblemSolver<spacedim>* solver = nullptr;
};

/// Defines who evaluates the quality of the cells, and so whether its cost is part of the method's
/// time.
enum class QualityUse {
  none,      ///< the method uses no mean ratio, and nodes of invalid cells are not reset
  loop,      ///< after each step the loop resets nodes of invalid cells and evaluates the quality
  smoother,  ///< the step keeps all cells valid and updates cell_quality
};

/// The resulting mesh of a method.
enum class ResultMesh {
  last,
  best_q_mean,
  best_q_star_min,
  best_score  ///< the score that the steps report
};

/// Properties of a smoother.
struct SmootherTraits {
  QualityUse quality_use = QualityUse::loop;
  ResultMesh result = ResultMesh::best_q_mean;
  bool needs_valid_mesh = true;
  /// True if the step visits nodes one after the other, so that its result depends on their order:
  /// the mesh keeps its order.
  bool needs_node_order = false;
  /// True if the step moves nodes only to positions of allowed_position
  /// (smoothing/mesh/node_constraints.h) and, unless the loop evaluates the quality, only where
  /// keeps_facet_bound holds. Other methods do not support meshes with constraints.
  bool keeps_constraints = false;
  /// True if the step moves cells towards the targets of the mesh
  /// (smoothing/quality/cell_targets.h). Other methods do not support meshes with targets.
  bool takes_targets = false;
  /// True if the step moves the midside nodes of meshes of second order by itself: it gets the
  /// whole mesh. For other methods these nodes follow the corners.
  bool moves_midside_nodes = false;
  /// True if the step works in parts of a mesh (smoothing/parts/mesh_part.h): it decides on its own
  /// nodes by the cells around them, in an order that does not depend on the parts, and copies of
  /// nodes are up to date after it. Its report is that of the whole mesh.
  bool works_in_parts = false;
};

/// Report of one step to the loop.
struct StepReport {
  std::size_t n_counted = 1;      ///< iterations in the method's own count (100 for a cycle of 100)
  double max_displacement = 0.0;  ///< longest movement of a node; needed by that criterion only
  bool converged = false;         ///< see StoppingRule::Criterion
  /// Number of cells that were invalid before nodes were reset; only from steps that reset them all
  /// at once.
  std::optional<std::size_t> n_made_invalid = {};
  std::size_t n_reset = 0;  ///< nodes (or elements) that were reset because a cell became invalid
  /// Quality of the mesh, from steps that keep it up to date; or only its q*_min if the rest would
  /// need a quality evaluation of every cell.
  std::optional<MeshQuality> quality = {};
  std::optional<double> q_star_min = {};
  double score = 0.0;  ///< score of the mesh, for ResultMesh::best_score
  /// The nodes that the step has moved, if they are few; otherwise nothing. Valid until the next
  /// step.
  std::optional<std::span<const NodeIndex>> moved = {};
  /// The stage's time so far, if the step knows it better than a clock around it. An external
  /// program reports its time without its start and its files.
  std::optional<double> stage_seconds = {};
  /// Wall time of the program run that this mesh comes from, from its start to its end.
  std::optional<double> wall_seconds = {};
};

/// Failure of a method on a mesh, for example of an external program. The method's row of results
/// has the reason, and studies continue with the other methods.
class SmootherFailure : public InputError {
 public:
  using InputError::InputError;
};

/// Folders of the files that smoothers read and write.
struct SmootherFolders {
  std::filesystem::path given = ".";  ///< base of relative file names that users give
  std::filesystem::path log = {};     ///< file for the output of an external program; empty: none
};

/// Origin of a smoother that is not part of this program, for the provenance.
struct SmootherOrigin {
  std::vector<std::filesystem::path> files = {};  ///< programs, scripts, libraries
  std::string version = {};                       ///< as it reports itself; may be empty
};

/// One way to move the free nodes of a mesh. A new method is one file: a class template over the
/// dimension that derives from this class and registers itself (catalogue.h). The loop (smooth.h)
/// does everything that methods share. Steps may use several threads (parallel.h).
template <int dim, int spacedim = dim>
class Smoother {
 public:
  virtual ~Smoother() = default;

  /// Returns the name of the stage in results, also the prefix of its parameters in methods of
  /// several stages.
  virtual std::string_view name() const = 0;
  virtual Parameters parameters() { return {}; }
  virtual SmootherTraits traits() const { return {}; }
  virtual StoppingRule stopping() const { return QualityGainStopping().rule(); }

  /// Called once before the first step. Compute here what depends on the topology only.
  virtual void initialize(const SmoothingState<dim, spacedim>& /*state*/) {}

  /// Checks parameters that depend on each other; called when all are set. Throws InputError.
  virtual void check_parameters() const {}

  /// Sets the folders of files; called before all other functions in studies and commands.
  virtual void use_folders(const SmootherFolders& /*folders*/) {}

  /// Returns the origin; called when a study begins. May start a program to get its version.
  virtual SmootherOrigin origin() { return {}; }

  /// Returns the score of the mesh that was passed to initialize, for ResultMesh::best_score.
  virtual double initial_score() const { return 0.0; }

  /// Moves free nodes of state.mesh: one iteration. Fixed nodes stay, except nodes that slide at
  /// the user's request.
  virtual StepReport step(SmoothingState<dim, spacedim>& state) = 0;
};

}  // namespace smoothfem
