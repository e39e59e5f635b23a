#include "meshes/distortion/distort.h"

#include <cmath>
#include <numeric>
#include <string>

#include "meshes/distortion/counter_random.h"
#include "smoothing/mesh/input_error.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {

namespace {

using Coordinates = std::vector<Point<2>>;

void require_in_range(const DistortionParameters& p) {
  if (!(p.target_q_mean > 0.0 && p.target_q_mean < 1.0))
    throw InputError("the distortion's target mean quality " + std::to_string(p.target_q_mean) +
                     " is not between 0 and 1");
  if (p.n_candidates < 1)
    throw InputError("the distortion needs at least 1 candidate a node, not " +
                     std::to_string(p.n_candidates));
  if (p.n_sweeps < 1)
    throw InputError("the distortion needs at least 1 sweep, not " + std::to_string(p.n_sweeps));
  if (!(p.tolerance > 0.0)) throw InputError("the distortion's tolerance must be positive");
}

/// Uniform in the unit disk. By rejection: sine and cosine differ between machines.
Point<2> point_in_unit_disk(SplitMix64& random) {
  while (true) {
    const Point<2> point(2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0);
    if (point.squaredNorm() <= 1.0) return point;
  }
}

/// In a ball larger than the node's cells few places are valid; some nodes have hardly any.
constexpr int tries_per_candidate = 20;

class Distortion {
 public:
  Distortion(const PlanarMesh& mesh, const DistortionParameters& parameters)
      : mesh_(mesh), original_(mesh.coordinates()), parameters_(parameters) {
    const Topology& topology = mesh.topology();
    edge_length_.resize(mesh.n_nodes(), 0.0);
    for (const NodeIndex i : topology.free_nodes()) {
      for (const NodeIndex j : topology.node_neighbours(i))
        edge_length_[i] += (original_[j] - original_[i]).norm();
      edge_length_[i] /= static_cast<double>(topology.node_neighbours(i).size());
    }
  }

  /// Coordinates for a radius, and the mean quality they give.
  double apply(double radius) {
    mesh_.coordinates() = original_;
    for (int sweep = 0; sweep < parameters_.n_sweeps; ++sweep)
      for (const NodeIndex node : mesh_.topology().free_nodes()) move(node, sweep, radius);
    return mesh_quality(mesh_).q_mean;
  }

  const Coordinates& coordinates() const { return mesh_.coordinates(); }

 private:
  void move(NodeIndex node, int sweep, double radius) {
    Point<2>& place = mesh_.coordinates()[node];
    const Point<2> present = place;
    Point<2> worst = present;
    double worst_quality = 2.0;  // above every mean ratio
    SplitMix64 random = counter_random(parameters_.seed, node, static_cast<std::uint64_t>(sweep));
    const int n_tries = tries_per_candidate * parameters_.n_candidates;
    for (int i = 0, n_valid = 0; i < n_tries && n_valid < parameters_.n_candidates; ++i) {
      place = original_[node] + radius * edge_length_[node] * point_in_unit_disk(random);
      const double quality = quality_around(node);
      if (!(quality > 0.0)) continue;
      ++n_valid;
      if (quality < worst_quality) {
        worst_quality = quality;
        worst = place;
      }
    }
    place = worst;
  }

  /// Mean quality of a node's cells; 0 if one is invalid.
  double quality_around(NodeIndex node) const {
    double sum = 0.0;
    const auto cells = mesh_.topology().node_cells(node);
    for (const CellIndex cell : cells) {
      const double quality = cell_mean_ratio(mesh_, cell);
      if (!(quality > 0.0)) return 0.0;
      sum += quality;
    }
    return sum / static_cast<double>(cells.size());
  }

  PlanarMesh mesh_;
  Coordinates original_;
  std::vector<double> edge_length_;  ///< mean over the edges at a node, in the original mesh
  DistortionParameters parameters_;
};

/// Balls of this radius contain the cells of nearly every node; larger ones change nothing.
constexpr double largest_radius = 4.0;
constexpr int n_scan_steps = 16;
constexpr int n_bisections = 40;
constexpr int n_neighbours = 400;
constexpr double neighbour_distance = 1e-4;  ///< relative to the radius

}  // namespace

DistortionResult distort(PlanarMesh& mesh, const DistortionParameters& parameters) {
  require_in_range(parameters);
  require_valid(mesh);
  const double target = parameters.target_q_mean;
  Distortion distortion(mesh, parameters);
  DistortionResult result{0.0, mesh_quality(mesh).q_mean};
  const double q_initial = result.q_mean;
  const auto reached = [&](double radius) {
    result = {radius, distortion.apply(radius)};
    return std::abs(result.q_mean - target) <= parameters.tolerance;
  };
  if (std::abs(q_initial - target) <= parameters.tolerance) return result;
  if (q_initial < target)
    throw InputError("the distortion cannot reach the mean quality " + std::to_string(target) +
                     ", because the mesh itself has " + std::to_string(q_initial) +
                     "; distortion only lowers it");

  // The mean quality falls with the radius until the balls hold all valid places: the first step
  // below the target brackets the radius.
  double q_lowest = q_initial, lower = 0.0, upper = 0.0;
  for (int step = 1; step <= n_scan_steps && !(q_lowest < target); ++step) {
    lower = upper;
    upper = largest_radius * step / n_scan_steps;
    reached(upper);
    q_lowest = std::min(q_lowest, result.q_mean);
  }
  if (q_lowest >= target)
    throw InputError("the distortion cannot reach the mean quality " + std::to_string(target) +
                     "; on this mesh it reaches values from " + std::to_string(q_lowest) + " to " +
                     std::to_string(q_initial));
  for (int i = 0; i < n_bisections && !reached(0.5 * (lower + upper)); ++i)
    (result.q_mean > target ? lower : upper) = result.radius;
  // On small meshes the quality jumps over the target where one node's choice changes; other jumps
  // lie next to it.
  const double jump = result.radius;
  for (int i = 1; i <= n_neighbours && std::abs(result.q_mean - target) > parameters.tolerance; ++i)
    reached(jump * (1.0 + (i % 2 == 0 ? -0.5 : 0.5) * i * neighbour_distance));
  if (std::abs(result.q_mean - target) > parameters.tolerance)
    throw InputError("the distortion came no closer to the mean quality " + std::to_string(target) +
                     " than " + std::to_string(result.q_mean) +
                     "; the mesh is too small for this tolerance");
  mesh.coordinates() = distortion.coordinates();
  return result;
}

}  // namespace smoothfem
