// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/doctor/examinations/seams.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>
#include <cmath>

#include "meshes/doctor/examinations/disjoint_sets.h"
#include "smoothing/surface/nearest_point.h"

namespace smoothfem {

namespace {

namespace bg = boost::geometry;
using TreePoint = bg::model::point<double, 3, bg::cs::cartesian>;
using TreeBox = bg::model::box<TreePoint>;
template <class Shape>
using Tree = bg::index::rtree<std::pair<Shape, std::uint32_t>, bg::index::rstar<16>>;

TreePoint tree_point(const Point<3>& p) {
  return {p.x(), p.y(), p.z()};
}
TreeBox tree_box(const Eigen::AlignedBox3d& box, double margin) {
  const Point<3> more = Point<3>::Constant(margin);
  return {tree_point(box.min() - more), tree_point(box.max() + more)};
}

/// Calls visit(number) for the tree's entries that meet a shape.
template <class Shape, class Sought, class Visit>
void search(const Tree<Shape>& tree, const Sought& sought, const Visit& visit) {
  tree.query(bg::index::intersects(sought),
             boost::make_function_output_iterator([&](const auto& entry) { visit(entry.second); }));
}

/// A boundary facet and how near to it nodes hang.
class Target {
 public:
  Target(std::span<const NodeIndex> nodes, std::span<const Point<3>> points, double mesh_size)
      : nodes_(nodes), points_(points) {
    double shortest = mesh_size;
    for (std::size_t k = 0; k < nodes.size(); ++k)
      shortest = std::min(shortest, (corner(k) - corner((k + 1) % nodes.size())).norm());
    tolerance_ = std::min(1e-3 * shortest, 1e-6 * mesh_size);
  }

  TreeBox box() const {
    Eigen::AlignedBox3d box;
    for (std::size_t k = 0; k < nodes_.size(); ++k) box.extend(corner(k));
    return tree_box(box, tolerance_);
  }

  bool has_inside(NodeIndex node) const {
    const Point<3>& p = points_[node];
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      if ((p - corner(k)).norm() <= tolerance_) return false;
    return (nearest(p) - p).norm() <= tolerance_;
  }

 private:
  const Point<3>& corner(std::size_t k) const { return points_[nodes_[k]]; }

  Point<3> nearest(const Point<3>& p) const {
    if (nodes_.size() == 2) return nearest_on_segment(p, corner(0), corner(1));
    if (nodes_.size() == 3) return nearest_on_triangle(p, corner(0), corner(1), corner(2));
    const std::array corners{corner(0), corner(1), corner(2), corner(3)};
    return nearest_on_bilinear(p, corners).point(corners);
  }

  std::span<const NodeIndex> nodes_;
  std::span<const Point<3>> points_;
  double tolerance_;
};

bool has(std::span<const NodeIndex> nodes, NodeIndex node) {
  return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
}

}  // namespace

double size_of(const PlainCells& cells, const Skin& skin) {
  Eigen::AlignedBox3d box;
  for (const NodeIndex node : skin.nodes) box.extend(cells.points[node]);
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

std::vector<HangingNode> find_hanging_nodes(const PlainCells& cells, const Skin& skin) {
  const double size = size_of(cells, skin);
  std::vector<std::pair<TreeBox, std::uint32_t>> boxes;
  std::vector<Target> targets;
  boxes.reserve(skin.facets.size());
  targets.reserve(skin.facets.size());
  for (std::uint32_t f = 0; f < skin.facets.size(); ++f) {
    targets.emplace_back(skin.facets[f], cells.points, size);
    boxes.emplace_back(targets.back().box(), f);
  }
  const Tree<TreeBox> tree(boxes);
  std::vector<HangingNode> found;
  for (const NodeIndex node : skin.nodes) {
    std::uint32_t first = no_node;
    search(tree, tree_point(cells.points[node]), [&](std::uint32_t f) {
      if (f < first && !has(skin.facets[f], node) && targets[f].has_inside(node) &&
          !has(cells.cells[skin.cells[f]], node))
        first = f;
    });
    if (first != no_node) found.push_back({node, first});
  }
  return found;
}

namespace {

/// Returns for each node of the skin (by its position there) within what distance others coincide.
std::vector<double> reaches(const PlainCells& cells, const Skin& skin) {
  const auto at = [&](NodeIndex node) {
    return static_cast<std::size_t>(std::lower_bound(skin.nodes.begin(), skin.nodes.end(), node) -
                                    skin.nodes.begin());
  };
  std::vector<double> reach(skin.nodes.size(), 1e-9 * size_of(cells, skin));
  for (std::size_t f = 0; f < skin.facets.size(); ++f) {
    const auto nodes = skin.facets[f];
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const NodeIndex a = nodes[k], b = nodes[(k + 1) % nodes.size()];
      const double bound = 1e-3 * (cells.points[a] - cells.points[b]).norm();
      for (const NodeIndex end : {a, b}) reach[at(end)] = std::min(reach[at(end)], bound);
    }
  }
  return reach;
}

/// Separates the nodes in the places where a cell has two nodes: it would collapse.
void keep_nodes_of_one_cell_apart(const PlainCells& cells, std::vector<NodeIndex>& first) {
  std::vector<NodeIndex> places, apart;
  for (CellIndex c = 0; c < cells.cells.size(); ++c) {
    places.clear();
    for (const NodeIndex node : cells.cells[c]) places.push_back(first[node]);
    std::sort(places.begin(), places.end());
    for (std::size_t k = 1; k < places.size(); ++k)
      if (places[k] == places[k - 1]) apart.push_back(places[k]);
  }
  if (apart.empty()) return;
  std::sort(apart.begin(), apart.end());
  for (NodeIndex i = 0; i < first.size(); ++i)
    if (std::binary_search(apart.begin(), apart.end(), first[i])) first[i] = i;
}

/// Returns the number of facets that another one meets if coincident nodes become one.
std::size_t count_joined(const Skin& skin, const std::vector<NodeIndex>& first) {
  std::vector<std::array<NodeIndex, 4>> keys;
  for (std::size_t f = 0; f < skin.facets.size(); ++f) {
    std::array<NodeIndex, 4> key{no_node, no_node, no_node, no_node};
    const auto nodes = skin.facets[f];
    std::transform(nodes.begin(), nodes.end(), key.begin(), [&](NodeIndex i) { return first[i]; });
    std::sort(key.begin(), key.end());
    keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  const auto last = std::unique(keys.begin(), keys.end());
  return static_cast<std::size_t>(keys.end() - last);
}

}  // namespace

CoincidentNodes find_coincident_nodes(const PlainCells& cells, const Skin& skin) {
  const auto reach = reaches(cells, skin);
  std::vector<std::pair<TreePoint, std::uint32_t>> entries;
  entries.reserve(skin.nodes.size());
  for (std::uint32_t k = 0; k < skin.nodes.size(); ++k)
    entries.emplace_back(tree_point(cells.points[skin.nodes[k]]), k);
  const Tree<TreePoint> tree(entries);
  DisjointSets sets(skin.nodes.size());
  bool any = false;
  for (std::uint32_t k = 0; k < skin.nodes.size(); ++k) {
    const Point<3>& p = cells.points[skin.nodes[k]];
    search(tree, tree_box({p, p}, reach[k]), [&](std::uint32_t other) {
      if (other <= k) return;
      const double distance = (cells.points[skin.nodes[other]] - p).norm();
      if (distance > reach[k] || distance > reach[other]) return;
      sets.join(k, other);
      any = true;
    });
  }
  CoincidentNodes result;
  if (!any) return result;
  result.first.resize(cells.points.size());
  for (NodeIndex i = 0; i < result.first.size(); ++i) result.first[i] = i;
  for (std::uint32_t k = 0; k < skin.nodes.size(); ++k)
    result.first[skin.nodes[k]] = skin.nodes[sets.first_of(k)];
  keep_nodes_of_one_cell_apart(cells, result.first);
  for (NodeIndex i = 0; i < result.first.size(); ++i) result.count += result.first[i] != i;
  if (result.count == 0) result.first.clear();
  if (result.count > 0) result.n_joined = count_joined(skin, result.first);
  return result;
}

std::vector<bool> seam_flags(const PlainCells& cells, const Skin& skin,
                             const std::vector<HangingNode>& hanging,
                             const CoincidentNodes& coincident) {
  std::vector<bool> flags(cells.points.size(), false);
  for (const auto& [node, facet] : hanging) {
    flags[node] = true;
    for (const NodeIndex corner : skin.facets[facet]) flags[corner] = true;
  }
  for (NodeIndex i = 0; i < coincident.first.size(); ++i)
    if (!coincident.is_first(i)) flags[i] = flags[coincident.first[i]] = true;
  return flags;
}

}  // namespace smoothfem
