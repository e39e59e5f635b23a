// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

#include "meshes/distortion/counter_random.h"
#include "meshes/distortion/distort.h"
#include "smoothing/base/interruption.h"
#include "smoothing/geometry/unit_normal.h"
#include "smoothing/quality/hexahedron_mapping.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/simd/cells.h"

namespace smoothfem {

/// Looks for an interruption inside of parallel loops, whose threads must not throw. The thread
/// that made this object asks; the others see its answer.
class InterruptionInLoops {
 public:
  /// True if the loop is to end.
  bool has_come() {
    if (!ends_ && std::this_thread::get_id() == owner_) try {
        let_interrupt();
      } catch (...) {
        error_ = std::current_exception();
        ends_ = true;
      }
    return ends_;
  }
  /// Call it outside of the loops: throws the interruption.
  void rethrow() {
    ends_ = false;
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
    let_interrupt();
  }

 private:
  std::thread::id owner_ = std::this_thread::get_id();
  std::atomic<bool> ends_ = false;
  std::exception_ptr error_;
};

/// Returns a point that is uniform in the unit ball, by rejection: sine and cosine differ between
/// machines.
template <int dim>
Point<dim> point_in_unit_ball(SplitMix64& random) {
  while (true) {
    Point<dim> point;
    for (int d = dim - 1; d >= 0; --d) point[d] = 2.0 * random.uniform() - 1.0;
    // Here and below Eigen would sum in an order that depends on compiler flags.
    if (squared_length(vector_of(point)) <= 1.0) return point;
  }
}

/// Few points of a ball larger than the node's cells are valid; some nodes have hardly any.
constexpr int tries_per_candidate = 20;

/// Factor that shortens a step. With ten sweeps it gives the quantiles of mean ratio of the
/// published gears (see DistortionKind); with one half, their mean quality is not reached.
constexpr double step_shortening = 0.8;
constexpr int max_shortenings = 60;  // to a millionth

/// Computes the new position of one node of a mesh that is being distorted; the others stay.
template <int dim, int spacedim>
class NodeMoves {
 public:
  NodeMoves(const Mesh<dim, spacedim>& mesh, const DistortionParameters& parameters)
      : mesh_(mesh),
        original_(mesh.coordinates().begin(), mesh.coordinates().end()),
        edge_length_(mesh.n_nodes(), 0.0),
        parameters_(parameters) {
    // Cells that are worse from the beginning must not become even worse.
    min_quality_ = cell_mean_ratios(mesh);
    for (double& quality : min_quality_) quality = std::min(quality, parameters.min_quality);
    const Topology& topology = mesh.topology();
    for (const NodeIndex i : topology.free_nodes()) {
      for (const NodeIndex j : topology.node_neighbours(i))
        edge_length_[i] += length(vector_of(Point<spacedim>(original_[j] - original_[i])));
      edge_length_[i] /= static_cast<double>(topology.node_neighbours(i).size());
    }
  }

  Mesh<dim, spacedim>& mesh() { return mesh_; }
  const Mesh<dim, spacedim>& mesh() const { return mesh_; }
  /// Throws what an interruption during the moves raised.
  void throw_if_interrupted() { interruption_.rethrow(); }
  void undo_all() { std::copy(original_.begin(), original_.end(), mesh_.coordinates().begin()); }

  /// Returns a node's position after a sweep; its present position if there is no valid one.
  Point<spacedim> moved(NodeIndex node, int sweep, double radius) {
    return parameters_.kind == DistortionKind::random_steps ? stepped(node, sweep, radius)
                                                            : worst_candidate(node, sweep, radius);
  }

  /// Returns the mean quality of a node's cells; 0 if one is invalid, folded or below the smallest
  /// quality allowed.
  double quality_around(NodeIndex node) const {
    double sum = 0.0;
    const auto cells = mesh_.topology().node_cells(node);
    for (const CellIndex cell : cells) {
      const double quality = cell_mean_ratio(mesh_, cell);
      if (!(quality > 0.0) || quality < min_quality_[cell]) return 0.0;
      sum += quality;
    }
    if (std::any_of(cells.begin(), cells.end(), [&](CellIndex cell) { return is_folded(cell); }))
      return 0.0;
    return sum / static_cast<double>(cells.size());
  }

 private:
  static constexpr int tries_between_checks = 4096;

  SplitMix64 random_for(NodeIndex node, int sweep) const {
    return counter_random(parameters_.seed, node, static_cast<std::uint64_t>(sweep));
  }

  /// Returns the valid candidate of lowest quality; the node's present position if none is valid.
  Point<spacedim> worst_candidate(NodeIndex node, int sweep, double radius) {
    Point<spacedim>& x = mesh_.coordinates()[node];
    const Point<spacedim> present = x;
    Point<spacedim> worst = present;
    double worst_quality = 2.0;  // above every mean ratio
    SplitMix64 random = random_for(node, sweep);
    const int n_tries = tries_per_candidate * parameters_.n_candidates;
    for (int i = 0, n_valid = 0; i < n_tries && n_valid < parameters_.n_candidates; ++i) {
      if (i % tries_between_checks == tries_between_checks - 1 && interruption_.has_come()) break;
      x = allowed_position<dim, spacedim>(
          mesh_, node,
          original_[node] + radius * edge_length_[node] * point_in_unit_ball<spacedim>(random));
      const double quality = quality_around(node);
      if (!(quality > 0.0)) continue;
      ++n_valid;
      if (quality < worst_quality) {
        worst_quality = quality;
        worst = x;
      }
    }
    x = present;
    return worst;
  }

  /// Returns the node's position moved by a random vector, shortened until its cells are valid.
  Point<spacedim> stepped(NodeIndex node, int sweep, double radius) {
    Point<spacedim>& x = mesh_.coordinates()[node];
    Point<spacedim> present = x;
    SplitMix64 random = random_for(node, sweep);
    Point<spacedim> step = radius * edge_length_[node] * point_in_unit_ball<spacedim>(random);
    for (int i = 0; i < max_shortenings; ++i, step *= step_shortening) {
      x = allowed_position<dim, spacedim>(mesh_, node, present + step);
      if (!(quality_around(node) > 0.0)) continue;
      Point<spacedim> there = x;
      x = present;
      return there;
    }
    x = present;
    return present;
  }

  /// Cells must be valid not only at their corners: finite elements are solved on distorted
  /// hexahedra, and distorted surfaces are written to files.
  bool is_folded(CellIndex cell) const {
    if constexpr (dim == 3) {
      const auto nodes = mesh_.topology().cell_nodes(cell);
      if (nodes.size() != 8) return false;
      std::array<Point<3>, 8> corners;
      for (std::size_t k = 0; k < 8; ++k) corners[k] = mesh_.coordinates()[nodes[k]];
      return !has_positive_mapping(corners);
    } else if constexpr (spacedim > dim) {
      // Checks validity by its own mean normal, too: a file of the mesh has no other.
      bool valid = false;
      with_corners<dim>(
          mesh_.topology().cell_nodes(cell), mesh_.coordinates().data(),
          [&](auto corners) { valid = mean_ratio(unit_normal(corners), corners) > 0.0; });
      return !valid;
    }
    return false;
  }

  Mesh<dim, spacedim> mesh_;
  std::vector<Point<spacedim>> original_;
  std::vector<double> edge_length_;  ///< mean over the edges at a node, in the original mesh
  std::vector<double> min_quality_;  ///< of each cell
  DistortionParameters parameters_;
  InterruptionInLoops interruption_;
};

}  // namespace smoothfem
