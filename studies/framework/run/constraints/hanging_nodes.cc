// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/constraints/hanging_nodes.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <map>

#include "meshes/doctor/examinations/seams.h"
#include "smoothing/surface/nearest_point.h"

namespace smoothfem {

namespace {

using Points = std::span<const Point<3>>;
using Masters = std::vector<std::pair<NodeIndex, double>>;
using Facet = std::span<const NodeIndex>;

/// Returns the ends of the facet's edge that a point lies on, with weights; empty if there is none.
Masters on_edge(Facet facet, Points x, const Point<3>& p) {
  constexpr double allowed = 1e-3;  // of the edge's length
  for (std::size_t k = 0; k < facet.size(); ++k) {
    const NodeIndex a = facet[k], b = facet[(k + 1) % facet.size()];
    const Point<3> edge = x[b] - x[a];
    const double t = (p - x[a]).dot(edge) / edge.squaredNorm();
    if (t > 0.0 && t < 1.0 && (x[a] + t * edge - p).norm() <= allowed * edge.norm())
      return {{a, 1.0 - t}, {b, t}};
  }
  return {};
}

/// Returns the corners of a triangle with the barycentric coordinates of the nearest point of its
/// plane.
Masters in_triangle(Facet facet, Points x, const Point<3>& p) {
  Eigen::Matrix<double, 3, 2> edges;
  edges << x[facet[1]] - x[facet[0]], x[facet[2]] - x[facet[0]];
  const Eigen::Vector2d t =
      (edges.transpose() * edges).inverse() * (edges.transpose() * (p - x[facet[0]]));
  return {{facet[0], 1.0 - t.sum()}, {facet[1], t[0]}, {facet[2], t[1]}};
}

/// Returns the corners of a quadrilateral with the values of their bilinear functions at the
/// nearest point.
Masters in_quadrilateral(Facet facet, Points x, const Point<3>& p) {
  const auto weights =
      nearest_on_bilinear(p, {x[facet[0]], x[facet[1]], x[facet[2]], x[facet[3]]}).weights();
  Masters masters;
  for (std::size_t k = 0; k < weights.size(); ++k) masters.emplace_back(facet[k], weights[k]);
  return masters;
}

Masters masters_of(Facet facet, Points x, const Point<3>& p) {
  if (auto masters = on_edge(facet, x, p); !masters.empty()) return masters;
  return facet.size() == 4 ? in_quadrilateral(facet, x, p) : in_triangle(facet, x, p);
}

std::vector<NodeIndex> ascending(std::vector<NodeIndex> nodes) {
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// Finds the facets with hanging nodes whose masters all belong to one other facet: they lie in it.
std::set<std::vector<NodeIndex>> facets_of_seams(const Skin& skin,
                                                 const std::vector<NodeTie>& ties) {
  std::map<NodeIndex, const NodeTie*> of_node;
  for (const auto& tie : ties) of_node.emplace(tie.node, &tie);
  std::map<NodeIndex, std::vector<std::size_t>> facets_at;  // of masters
  for (const auto& tie : ties)
    for (const auto& master : tie.masters) facets_at.try_emplace(master.first);
  for (std::size_t f = 0; f < skin.facets.size(); ++f)
    for (const NodeIndex node : skin.facets[f])
      if (const auto found = facets_at.find(node); found != facets_at.end())
        found->second.push_back(f);
  std::set<std::vector<NodeIndex>> seams;
  for (std::size_t f = 0; f < skin.facets.size(); ++f) {
    const auto facet = skin.facets[f];
    std::vector<NodeIndex> corners;
    bool hangs = false;
    for (const NodeIndex node : facet) {
      const auto tie = of_node.find(node);
      hangs |= tie != of_node.end();
      if (tie == of_node.end())
        corners.push_back(node);
      else
        for (const auto& master : tie->second->masters) corners.push_back(master.first);
    }
    if (!hangs) continue;
    corners = ascending(std::move(corners));
    const auto candidates = facets_at.find(corners.front());
    if (candidates == facets_at.end()) continue;
    for (const std::size_t other : candidates->second) {
      const auto large = ascending({skin.facets[other].begin(), skin.facets[other].end()});
      if (other == f || !std::includes(large.begin(), large.end(), corners.begin(), corners.end()))
        continue;
      seams.insert(large);
      seams.insert(ascending({facet.begin(), facet.end()}));
    }
  }
  return seams;
}

}  // namespace

template <int dim>
NodeTies hanging_ties(const Mesh<dim>& mesh) {
  return with_plain_cells(mesh, [&](const PlainCells& cells) {
    const Skin skin = skin_of(mesh.topology());
    NodeTies ties;
    for (const auto& [node, facet] : find_hanging_nodes(cells, skin))
      ties.nodes.push_back(
          {node, masters_of(skin.facets[facet], cells.points, cells.points[node])});
    ties.inner_facets = facets_of_seams(skin, ties.nodes);
    return ties;
  });
}
template NodeTies hanging_ties(const Mesh<2>&);
template NodeTies hanging_ties(const Mesh<3>&);

}  // namespace smoothfem
