// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/periodic/periodic_maps.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <set>

namespace smoothfem {

namespace {

using Pair = std::array<NodeIndex, 2>;

/// Largest distance of a node from its partner's image, relative to the mesh.
constexpr double partner_tolerance = 1e-6;

template <int dim>
double width_of(const Mesh<dim>& mesh) {
  Point<dim> low = mesh.coordinates()[0], high = low;
  for (const Point<dim>& x : mesh.coordinates()) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return (high - low).norm();
}

template <int dim>
bool brings(const RigidMotion<dim>& motion, const Mesh<dim>& mesh, const Pair& pair, double bound) {
  return (motion(mesh.coordinates()[pair[1]]) - mesh.coordinates()[pair[0]]).norm() <= bound;
}

/// Returns the motion that brings the second node of each pair to the first one.
template <int dim>
std::optional<RigidMotion<dim>> motion_of(const Mesh<dim>& mesh, const std::vector<Pair>& pairs,
                                          double bound) {
  const auto x = mesh.coordinates();
  const auto is_motion = [&](const RigidMotion<dim>& motion) {
    return std::all_of(pairs.begin(), pairs.end(),
                       [&](const Pair& pair) { return brings(motion, mesh, pair, bound); });
  };
  RigidMotion<dim> motion;
  for (const auto& [node, partner] : pairs)
    motion.shift += (x[node] - x[partner]) / static_cast<double>(pairs.size());
  if (is_motion(motion)) return motion;
  Eigen::Matrix<double, dim, Eigen::Dynamic> from(dim, pairs.size()), to(dim, pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    to.col(static_cast<Eigen::Index>(k)) = x[pairs[k][0]];
    from.col(static_cast<Eigen::Index>(k)) = x[pairs[k][1]];
  }
  const Eigen::Matrix<double, dim + 1, dim + 1> fit = Eigen::umeyama(from, to, false);
  motion.rotation = fit.template topLeftCorner<dim, dim>();
  motion.shift = fit.template topRightCorner<dim, 1>();
  if (is_motion(motion)) return motion;
  return std::nullopt;
}

}  // namespace

template <int dim>
std::vector<PeriodicMap<dim>> periodic_maps(const Mesh<dim>& mesh) {
  std::vector<PeriodicMap<dim>> result;
  const FileContent* content = mesh.topology().labels().content.get();
  if (content == nullptr) return result;
  const double bound = partner_tolerance * width_of(mesh);
  for (const PeriodicEntity& entity : content->periodic) {
    if (entity.dimension != dim - 1 || entity.nodes.empty()) continue;
    const auto motion = motion_of(mesh, entity.nodes, bound);
    if (!motion)
      throw InputError(std::string("the nodes of the periodic ") +
                       (dim == 2 ? "curve " : "surface ") + std::to_string(entity.entity) +
                       " are not where a shift or a rotation brings those of its partner " +
                       std::to_string(entity.partner) + "; make the mesh periodic anew");
    result.push_back({*motion, entity.nodes});
  }
  for (PeriodicMap<dim>& map : result) {
    std::set<Pair> pairs(map.nodes.begin(), map.nodes.end());
    for (const PeriodicEntity& entity : content->periodic)
      if (entity.dimension < dim - 1)
        for (const Pair& pair : entity.nodes)
          if (brings(map.motion, mesh, pair, bound)) pairs.insert(pair);
    map.nodes.assign(pairs.begin(), pairs.end());
  }
  return result;
}

template std::vector<PeriodicMap<2>> periodic_maps(const Mesh<2>&);
template std::vector<PeriodicMap<3>> periodic_maps(const Mesh<3>&);

}  // namespace smoothfem
