// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/periodic/smooth_periodic.h"

#include <algorithm>
#include <cmath>

#include "smoothing/base/option_text.h"
#include "smoothing/loop/best_mesh.h"
#include "smoothing/loop/invalid_node_reset.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/mesh/interfaces.h"
#include "smoothing/periodic/halo.h"

namespace smoothfem {

namespace {

/// Flags the nodes between copied cells of different materials.
template <int dim>
std::vector<bool> between_materials(const Topology& with_copies, const Halo<dim>& halo,
                                    const std::vector<int>& materials) {
  std::vector<bool> flags(with_copies.n_nodes(), false);
  if (materials.empty()) return flags;
  for (NodeIndex i = 0; i < with_copies.n_nodes(); ++i) {
    const auto cells = with_copies.node_cells(i);
    flags[i] = std::any_of(cells.begin(), cells.end(), [&](CellIndex c) {
      return materials[halo.originals[c]] != materials[halo.originals[cells[0]]];
    });
  }
  return flags;
}

/// Returns the topology with copies. Periodic nodes that these surround are free, unless they stay
/// for another reason. constraints: null if the boundary does not slide.
template <int dim>
std::shared_ptr<const Topology> free_topology(const Mesh<dim>& mesh, const Halo<dim>& halo,
                                              const NodeConstraints<dim>* constraints) {
  const std::size_t n = mesh.n_nodes(), n_all = n + halo.copies.size();
  const Topology fixed(dim, n_all, halo.cells, std::vector<bool>(n_all, true));
  const auto is_between = between_materials(fixed, halo, cell_materials(mesh.topology()));
  std::vector<FixedReasons> reasons(n_all, bit(FixedReason::periodic));
  for (NodeIndex i = 0; i < n; ++i) {
    reasons[i] = mesh.topology().fixed_reasons(i);
    if (!has(reasons[i], FixedReason::periodic)) continue;
    if (fixed.on_boundary()[i] && !constraints) continue;
    reasons[i] &= static_cast<FixedReasons>(~bit(FixedReason::periodic));
    if (!fixed.on_boundary()[i])
      reasons[i] &= static_cast<FixedReasons>(~bit(FixedReason::boundary));
    if (is_between[i]) reasons[i] |= bit(FixedReason::interface);
    if (constraints && constraints->is_corner(i)) reasons[i] |= bit(FixedReason::corner);
  }
  return std::make_shared<const Topology>(dim, n_all, halo.cells, std::move(reasons), MeshLabels{});
}

/// A mesh and its periodic maps.
template <int dim>
class PeriodicMesh {
 public:
  explicit PeriodicMesh(const Mesh<dim>& mesh) : maps_(periodic_maps(mesh)) {
    if (maps_.empty())
      throw InputError("the mesh has no periodic partners; leave out " + option_text("periodic"));
    is_periodic_.assign(mesh.n_nodes(), false);
    for (const auto& map : maps_)
      for (const auto& pair : map.nodes) is_periodic_[pair[0]] = is_periodic_[pair[1]] = true;
  }
  const std::vector<PeriodicMap<dim>>& maps() const { return maps_; }

  /// Moves each free node to the image of its partner, unless the partner stays.
  void join_partners(const Topology& topology, std::span<Point<dim>> x) const {
    for (const auto& map : maps_)
      for (const auto& [node, partner] : map.nodes)
        if (!topology.is_fixed(node) && !topology.is_fixed(partner))
          x[node] = map.motion(x[partner]);
  }

  /// Returns the topology with more fixed nodes, so that partners are both free or both fixed.
  std::shared_ptr<const Topology> with_joint_reasons(const Topology& topology) const {
    auto reasons = topology.fixed_reasons();
    bool changed = true;
    while (changed) {
      changed = false;
      for (const auto& map : maps_)
        for (const auto& [node, partner] : map.nodes)
          if ((reasons[node] == 0) != (reasons[partner] == 0)) {
            reasons[node] |= bit(FixedReason::periodic);
            reasons[partner] |= bit(FixedReason::periodic);
            changed = true;
          }
    }
    return std::make_shared<const Topology>(dim, topology.n_nodes(), topology.cells(),
                                            std::move(reasons), MeshLabels{});
  }

  /// Resets nodes and their partners to their initial positions until no cell is worse than `floor`
  /// or invalid. Returns the number of nodes that it reset.
  std::size_t keep_floor(Mesh<dim>& mesh, std::span<const Point<dim>> initial, double floor) const {
    std::size_t n_reset = 0;
    std::vector<double> quality;
    while (true) {
      compute_cell_mean_ratios(mesh, quality);
      auto moved = reset_nodes_of_invalid_cells(mesh, initial, quality, floor);
      if (moved.empty()) return n_reset;
      n_reset += moved.size();
      bool again = true;
      while (again) {
        again = false;
        for (const auto& map : maps_)
          for (const auto& [node, partner] : map.nodes)
            for (const auto& [a, b] : {std::pair(node, partner), std::pair(partner, node)})
              if (mesh.coordinates()[a] == initial[a] && mesh.coordinates()[b] != initial[b]) {
                mesh.coordinates()[b] = initial[b];
                ++n_reset;
                again = true;
              }
      }
    }
  }

  /// Returns the longest movement of a periodic node relative to its mean distance from its
  /// neighbours.
  double movement(const Mesh<dim>& mesh, std::span<const Point<dim>> before) const {
    double longest = 0.0;
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
      if (!is_periodic_[i]) continue;
      double sum = 0.0;
      const auto neighbours = mesh.topology().node_neighbours(i);
      for (const NodeIndex j : neighbours)
        sum += (mesh.coordinates()[j] - mesh.coordinates()[i]).norm();
      longest = std::max(longest, (mesh.coordinates()[i] - before[i]).norm() *
                                      static_cast<double>(neighbours.size()) / sum);
    }
    return longest;
  }

 private:
  std::vector<PeriodicMap<dim>> maps_;
  std::vector<bool> is_periodic_;
};

/// A method of one stage, which is taken from another method during its lifetime.
template <int dim>
class StageAlone {
 public:
  StageAlone(Method<dim>& method, std::size_t stage)
      : owner_(method.stages[stage]), alone_{method.info, {}, method.problem, method.floor} {
    alone_.stages.push_back(std::move(owner_));
  }
  ~StageAlone() { owner_ = std::move(alone_.stages.front()); }
  StageAlone(const StageAlone&) = delete;

  Method<dim>& method() { return alone_; }
  /// The stage's rule for its result. Scores of single steps say nothing about joined partners.
  ResultMesh result() const {
    const ResultMesh rule = alone_.stages.front()->traits().result;
    return rule == ResultMesh::best_score ? ResultMesh::best_q_star_min : rule;
  }

 private:
  std::unique_ptr<Smoother<dim>>& owner_;
  Method<dim> alone_;
};

}  // namespace

template <int dim>
SurfaceFacets without_periodic_facets(const Mesh<dim>& mesh, const SurfaceFacets& facets) {
  SurfaceFacets rest{.nodes = {}, .tags = {}, .marked_edges = facets.marked_edges};
  const auto maps = periodic_maps(mesh);
  std::vector<bool> on_side(mesh.n_nodes());
  std::vector<bool> is_periodic(facets.nodes.size(), false);
  for (const auto& map : maps)
    for (const std::size_t side : {0, 1}) {
      on_side.assign(mesh.n_nodes(), false);
      for (const auto& pair : map.nodes) on_side[pair[side]] = true;
      for (std::size_t f = 0; f < facets.nodes.size(); ++f) {
        const auto nodes = facets.nodes[f];
        if (std::all_of(nodes.begin(), nodes.end(), [&](NodeIndex i) { return on_side[i]; }))
          is_periodic[f] = true;
      }
    }
  for (std::size_t f = 0; f < facets.nodes.size(); ++f) {
    if (is_periodic[f]) continue;
    rest.nodes.append(facets.nodes[f]);
    if (!facets.tags.empty()) rest.tags.push_back(facets.tags[f]);
  }
  return rest;
}

template <int dim>
SmoothingResult smooth_periodic(Mesh<dim>& mesh, Method<dim>& method,
                                const std::type_identity_t<Observer<dim>>& observer,
                                const PeriodicParameters<dim>& parameters) {
  if (mesh.targets())
    throw InputError("targets and periodic partners that move cannot be combined; leave out one");
  const PeriodicMesh<dim> periodic(mesh);
  const Halo<dim> halo = make_halo(mesh, periodic.maps(), parameters.n_layers);
  const auto initial = mesh.copied_coordinates();
  const MeshQuality initial_quality = mesh_quality(mesh);
  std::shared_ptr<const NodeConstraints<dim>> constraints;
  if (parameters.make_constraints)
    constraints = parameters.make_constraints(halo.coordinates(initial));
  const auto topology = periodic.with_joint_reasons(*free_topology(mesh, halo, constraints.get()));
  SmoothingResult result;
  std::size_t n_records = 0;
  Mesh<dim> seen = mesh;
  Observer<dim> of_mesh;
  if (observer)
    of_mesh = [&](const IterationRecord& record, const Mesh<dim>& now) {
      if (n_records > 0 && record.record == 0) return;
      seen.set_coordinates(now.coordinates().first(mesh.n_nodes()));
      IterationRecord of_round = record;
      of_round.record = n_records++;
      of_round.quality = mesh_quality(seen);
      of_round.smoothing_seconds += result.smoothing_seconds;
      observer(of_round, seen);
    };
  // All rounds of a stage come before the next stage: in turn, stages would undo each other's work.
  for (std::size_t s = 0; s < method.stages.size(); ++s) {
    StageAlone<dim> stage(method, s);
    StageResult total;
    BestMesh<dim> best(stage.result(), std::as_const(mesh).coordinates(), mesh_quality(mesh), 0.0);
    int n_not_better = 0;
    for (int round = 0; round < parameters.max_rounds; ++round) {
      const auto before = mesh.copied_coordinates();
      Mesh<dim> extended(topology, halo.coordinates(mesh.coordinates()), constraints);
      const SmoothingResult of_round = smooth(extended, stage.method(), of_mesh);
      result.smoothing_seconds += of_round.smoothing_seconds;
      result.preparation_seconds += of_round.preparation_seconds;
      const std::size_t earlier = total.iterations;
      total = of_round.stages.front();
      total.iterations += earlier;
      mesh.set_coordinates(std::as_const(extended).coordinates().first(mesh.n_nodes()));
      periodic.join_partners(*topology, mesh.coordinates());
      const bool is_best = best.offer(std::as_const(mesh).coordinates(), mesh_quality(mesh), {});
      n_not_better = is_best || stage.result() == ResultMesh::last ? 0 : n_not_better + 1;
      if (n_not_better == parameters.patience) break;
      if (periodic.movement(mesh, before) <= parameters.tolerance) break;
    }
    best.restore(mesh);
    result.stages.push_back(std::move(total));
  }
  // A method without quality control may leave invalid cells.
  const bool is_controlled = std::all_of(
      method.stages.begin(), method.stages.end(),
      [](const auto& stage) { return stage->traits().quality_use != QualityUse::none; });
  if (initial_quality.n_invalid == 0 && (is_controlled || method.floor != 0))
    result.n_floor_reset +=
        periodic.keep_floor(mesh, initial, method.floor != 0 ? initial_quality.q_min : 0.0);
  result.quality = mesh_quality(mesh);
  const bool has_moved =
      !std::equal(initial.begin(), initial.end(), std::as_const(mesh).coordinates().begin());
  result.result_record = has_moved ? std::max<std::size_t>(n_records, 2) - 1 : 0;
  return result;
}

template SurfaceFacets without_periodic_facets(const Mesh<2>&, const SurfaceFacets&);
template SurfaceFacets without_periodic_facets(const Mesh<3>&, const SurfaceFacets&);
template SmoothingResult smooth_periodic(Mesh<2>&, Method<2>&, const Observer<2>&,
                                         const PeriodicParameters<2>&);
template SmoothingResult smooth_periodic(Mesh<3>&, Method<3>&, const Observer<3>&,
                                         const PeriodicParameters<3>&);

}  // namespace smoothfem
