// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/second_order/raise_order.h"

#include <map>

namespace smoothfem {

namespace {

/// Returns the number of midside nodes of an element.
std::size_t n_midside_of(int dim, std::size_t n_corners, SecondOrderKind kind) {
  std::size_t least = 0, most = 0;
  for (std::size_t n = 1; n <= 19; ++n)
    if (midside_counts(dim, n_corners, n).sum() == n) {
      if (least == 0) least = n;
      most = n;
    }
  // A triangle's node in the middle is not needed for completeness.
  return kind == SecondOrderKind::serendipity || (dim == 2 && n_corners == 3) ? least : most;
}

/// The midside nodes of a mesh that gets them.
template <int dim>
class NewNodes {
 public:
  NewNodes(const Mesh<dim>& mesh, SecondOrderKind kind)
      : kind_(kind), points_(mesh.copied_coordinates()) {}

  /// Returns the nodes of an element of dimension `d`; new ones where it is the first.
  std::vector<NodeIndex> nodes_of(int d, std::span<const NodeIndex> corners) {
    std::vector<NodeIndex> row(n_midside_of(d, corners.size(), kind_), no_corner);
    std::size_t k = 0;
    for_each_midside_place(d, corners, row, [&](const MidsidePlace& place, NodeIndex) {
      const auto [found, is_new] =
          nodes_.try_emplace(place, static_cast<NodeIndex>(points_.size()));
      if (is_new)
        points_.push_back(d == dim && k + 1 == row.size() && has_cell_node(d, corners, row)
                              ? mean_of(corners)
                              : mean_of(place));
      row[k++] = found->second;
    });
    return row;
  }

  std::vector<Point<dim>> points() && { return std::move(points_); }

 private:
  static bool has_cell_node(int d, std::span<const NodeIndex> corners,
                            std::span<const NodeIndex> row) {
    return midside_counts(d, corners.size(), row.size()).cell > 0;
  }
  /// Returns the mean of the corners, to which all straight places are equal.
  Point<dim> mean_of(std::span<const NodeIndex> corners) const {
    Point<dim> sum = Point<dim>::Zero();
    std::size_t n = 0;
    for (const NodeIndex node : corners)
      if (node != no_corner) {
        sum += points_[node];
        ++n;
      }
    return sum / static_cast<double>(n);
  }

  SecondOrderKind kind_;
  std::vector<Point<dim>> points_;
  std::map<MidsidePlace, NodeIndex> nodes_;
};

}  // namespace

template <int dim>
Mesh<dim> with_midside_nodes(const Mesh<dim>& mesh, SecondOrderKind kind) {
  const Topology& topology = mesh.topology();
  if (topology.midside()) throw InputError("the mesh is of second order already");
  NewNodes<dim> nodes(mesh, kind);
  MidsideNodes midside;
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    if (topology.cell_type(c) == ElementType::polygon)
      throw CellError(c, "has more than four corners; there is no such element of second order");
    midside.of_cells.append(nodes.nodes_of(dim, topology.cell_nodes(c)));
  }
  MeshLabels labels = topology.labels();
  for (std::size_t f = 0; f < labels.facets.size(); ++f)
    midside.of_facets.append(nodes.nodes_of(dim - 1, labels.facets[f]));
  labels.node_ids.clear();
  labels.content = nullptr;
  labels.midside = std::make_shared<const MidsideNodes>(std::move(midside));
  auto points = std::move(nodes).points();
  auto reasons = topology.fixed_reasons();
  reasons.resize(points.size(), 0);
  return {std::make_shared<const Topology>(dim, points.size(), topology.cells(), std::move(reasons),
                                           std::move(labels)),
          std::move(points), mesh.shared_constraints(), mesh.shared_targets()};
}

template Mesh<2> with_midside_nodes(const Mesh<2>&, SecondOrderKind);
template Mesh<3> with_midside_nodes(const Mesh<3>&, SecondOrderKind);

}  // namespace smoothfem
