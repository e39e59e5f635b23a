// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/distortion/distort.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "meshes/distortion/node_moves.h"
#include "smoothing/base/input_error.h"
#include "smoothing/base/interruption.h"
#include "smoothing/base/parallel.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {

namespace {

void require_in_range(const DistortionParameters& p) {
  if (!(p.target_q_mean > 0.0 && p.target_q_mean < 1.0))
    throw InputError("the distortion's target mean quality " + std::to_string(p.target_q_mean) +
                     " is not between 0 and 1");
  if (p.n_candidates < 1)
    throw InputError("the distortion needs at least 1 candidate for each node, not " +
                     std::to_string(p.n_candidates));
  if (p.n_sweeps < 1)
    throw InputError("the distortion needs at least 1 sweep, not " + std::to_string(p.n_sweeps));
  if (!(p.min_quality >= 0.0 && p.min_quality < 1.0))
    throw InputError("the distortion's least quality " + std::to_string(p.min_quality) +
                     " is not between 0 and 1");
  if (!(p.tolerance > 0.0)) throw InputError("the distortion's tolerance must be positive");
}

/// Fewer nodes of a level are not worth a thread. Nodes of volume meshes take far longer.
constexpr std::size_t min_nodes_per_thread(int dim) {
  return dim == 2 ? 64 : 4;
}

template <int dim, int spacedim>
class Distortion {
 public:
  Distortion(const Mesh<dim, spacedim>& mesh, const DistortionParameters& parameters)
      : moves_(mesh, parameters),
        n_sweeps_(parameters.n_sweeps),
        grain_(parameters.n_candidates < many_candidates ? min_nodes_per_thread(dim) : 1),
        levels_(dependency_levels(mesh.topology())) {}

  /// Moves all nodes within a radius. Returns the resulting mean quality.
  double apply(double radius) {
    moves_.undo_all();
    for (int sweep = 0; sweep < n_sweeps_; ++sweep)
      for (std::size_t level = 0; level < levels_.size(); ++level) {
        moves_.throw_if_interrupted();
        const auto nodes = levels_[level];
        parallel_for_ranges(nodes.size(), grain_, [&](std::size_t first, std::size_t last) {
          for (const NodeIndex node : nodes.subspan(first, last - first))
            moves_.mesh().coordinates()[node] = moves_.moved(node, sweep, radius);
        });
      }
    moves_.throw_if_interrupted();
    return mesh_quality(moves_.mesh()).q_mean;
  }

  /// Moves further nodes, one after the other, until the mean quality has fallen from above the
  /// target to it. The last node stops on its way. That way is valid: the points that keep a node's
  /// cells valid form a convex set, because the Jacobian at each point is linear in the node's
  /// coordinates. On surfaces this holds nearly, and validity is checked. Returns false if the
  /// target is not reached.
  bool finish(double target, double radius) {
    const auto n_cells = static_cast<double>(moves_.mesh().n_cells());
    double excess = (mesh_quality(moves_.mesh()).q_mean - target) * n_cells;
    for (const NodeIndex node : moves_.mesh().topology().free_nodes()) {
      Point<spacedim>& x = moves_.mesh().coordinates()[node];
      const Point<spacedim> from = x, to = moves_.moved(node, n_sweeps_, radius);
      const auto degree = static_cast<double>(moves_.mesh().topology().node_cells(node).size());
      const double before = moves_.quality_around(node);
      x = to;
      const double loss = degree * (before - moves_.quality_around(node));
      if (loss < excess) {
        if (loss > 0.0)
          excess -= loss;
        else
          x = from;
        continue;
      }
      double low = 0.0, high = 1.0;
      for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        x = allowed_position<dim, spacedim>(moves_.mesh(), node,
                                            (1.0 - middle) * from + middle * to);
        const double quality = moves_.quality_around(node);
        (quality > 0.0 && degree * (before - quality) < excess ? low : high) = middle;
      }
      x = allowed_position<dim, spacedim>(moves_.mesh(), node, (1.0 - low) * from + low * to);
      return true;
    }
    return false;
  }

  const Mesh<dim, spacedim>& mesh() const { return moves_.mesh(); }
  void copy_to(Mesh<dim, spacedim>& mesh) const {
    const auto x = moves_.mesh().coordinates();
    std::copy(x.begin(), x.end(), mesh.coordinates().begin());
  }

 private:
  /// Returns the free nodes in levels. Nodes of one level move at the same time, with the result of
  /// moving them one after the other. A node depends on the earlier nodes that share a cell with
  /// it, and so its level comes after theirs.
  static CompressedRows<NodeIndex> dependency_levels(const Topology& topology) {
    std::vector<std::size_t> level_of_node(topology.n_nodes(), 0);
    std::vector<std::vector<NodeIndex>> levels;
    for (const NodeIndex node : topology.free_nodes()) {
      std::size_t level = 0;
      for (const CellIndex cell : topology.node_cells(node))
        for (const NodeIndex other : topology.cell_nodes(cell))
          if (other < node && !topology.is_fixed(other))
            level = std::max(level, level_of_node[other] + 1);
      level_of_node[node] = level;
      if (level == levels.size()) levels.emplace_back();
      levels[level].push_back(node);
    }
    CompressedRows<NodeIndex> rows;
    for (const auto& nodes : levels) rows.append(nodes);
    return rows;
  }

  NodeMoves<dim, spacedim> moves_;
  /// With so many candidates a thread takes one node at a time, so that interruptions do not wait.
  static constexpr int many_candidates = 10000;

  int n_sweeps_;
  std::size_t grain_;
  CompressedRows<NodeIndex> levels_;
};

/// Balls of this radius contain the cells of nearly every node; larger ones change nothing.
constexpr double largest_radius = 4.0;
constexpr int n_scan_steps = 16;
constexpr int n_bisections = 12;

std::string not_reached(double target, double q_lowest, double q_initial) {
  return "the distortion cannot reach the mean quality " + std::to_string(target) +
         "; on this mesh it reaches values from " + std::to_string(q_lowest) + " to " +
         std::to_string(q_initial);
}

}  // namespace

template <int dim, int spacedim>
double distort_within(Mesh<dim, spacedim>& mesh, double radius,
                      const DistortionParameters& parameters) {
  require_in_range(parameters);
  require_linear(mesh.topology(), "distortion");
  require_valid(mesh);
  Distortion<dim, spacedim> distortion(mesh, parameters);
  const double q_mean = distortion.apply(radius);
  distortion.copy_to(mesh);
  return q_mean;
}

template <int dim, int spacedim>
DistortionResult distort(Mesh<dim, spacedim>& mesh, const DistortionParameters& parameters) {
  require_in_range(parameters);
  require_linear(mesh.topology(), "distortion");
  require_valid(mesh);
  const double target = parameters.target_q_mean;
  const double q_initial = mesh_quality(mesh).q_mean;
  if (std::abs(q_initial - target) <= parameters.tolerance) return {0.0, q_initial};
  if (q_initial < target)
    throw InputError("the distortion cannot reach the mean quality " + std::to_string(target) +
                     ", because the mesh itself has " + std::to_string(q_initial) +
                     "; distortion only lowers it");

  // The mean quality falls with the radius until the balls hold all valid points. The first step
  // below the target brackets the radius.
  Distortion<dim, spacedim> distortion(mesh, parameters);
  double lower = 0.0, upper = 0.0, q_lowest = q_initial;
  for (int step = 1; step <= n_scan_steps && q_lowest >= target; ++step) {
    lower = upper;
    upper = largest_radius * step / n_scan_steps;
    q_lowest = std::min(q_lowest, distortion.apply(upper));
  }
  if (q_lowest >= target) throw InputError(not_reached(target, q_lowest, q_initial));
  for (int i = 0; i < n_bisections; ++i) {
    const double middle = 0.5 * (lower + upper);
    (distortion.apply(middle) > target ? lower : upper) = middle;
  }
  // The quality jumps where a node's choice changes; the jumps are large on small meshes.
  if (distortion.apply(lower) > target && !distortion.finish(target, upper))
    throw InputError(not_reached(target, q_lowest, q_initial));
  const DistortionResult result{lower, mesh_quality(distortion.mesh()).q_mean};
  if (std::abs(result.q_mean - target) > parameters.tolerance)
    throw InputError(not_reached(target, q_lowest, q_initial));
  distortion.copy_to(mesh);
  return result;
}

template double distort_within(Mesh<2>&, double, const DistortionParameters&);
template double distort_within(Mesh<3>&, double, const DistortionParameters&);
template DistortionResult distort(Mesh<2>&, const DistortionParameters&);
template DistortionResult distort(Mesh<3>&, const DistortionParameters&);
template double distort_within(Mesh<2, 3>&, double, const DistortionParameters&);
template DistortionResult distort(Mesh<2, 3>&, const DistortionParameters&);

}  // namespace smoothfem
