// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "smoothing/loop/smooth.h"
#include "smoothing/mesh/mesh.h"
#include "smoothing/mesh/node_constraints.h"

namespace smoothfem {

/// Moves the midside nodes of a mesh of second order after its corners.
///
/// A node whose edge, face or cell has no moved corner stays, so that boundaries and interfaces
/// keep their curves and surfaces. Any other node goes to its straight place: the middle of its
/// edge; in a face or a cell the place that the nodes of its edges and faces ask for (transfinite
/// interpolation). Straight inner cells have affine mappings, for which elements of degree 2 are
/// best. Where corners slide on a surface, its midside nodes go to the nearest place on it. But a
/// curved boundary may cut through straight edges. Where a cell becomes invalid, or
/// worse than the worst one asked for, nodes inside take on their initial curvature again, a
/// quarter at a time: the offset from the straight place, turned and scaled with the edge. Where
/// that does not suffice, corners go back to their initial places.
template <int dim>
class MidsidePlacement {
 public:
  /// initial: a mesh of second order, whose midside nodes define the curves.
  explicit MidsidePlacement(const Mesh<dim>& initial);

  /// Returns the topology of the initial mesh without its midside nodes.
  const std::shared_ptr<const Topology>& without_midside() const { return without_midside_; }

  /// Moves midside nodes of cells that are not proven to be valid, although their corners are
  /// valid, towards their straight places, an eighth at a time, until the cells are valid. The
  /// result becomes the initial mesh, and `mesh` gets its nodes. cell_quality: gets the mean ratio
  /// of each curved cell of the result.
  MidsideReport repair(Mesh<dim>& mesh, std::vector<double>& cell_quality);

  /// Places the midside nodes of a mesh of the same topology. floor: least mean ratio of cells, not
  /// above that of the initial mesh. cell_quality: gets the mean ratio of each curved cell. If the
  /// initial mesh is valid, so is the result.
  MidsideReport place(Mesh<dim>& mesh, double floor, std::vector<double>& cell_quality) const;

 private:
  struct EdgeNode {
    NodeIndex node, a, b;
  };
  /// A node in the middle of a face or a cell. Its straight place is a weighted sum of the corners,
  /// the nodes of the edges and those of the faces.
  struct MiddleNode {
    NodeIndex node;
    std::vector<NodeIndex> corners, edges, faces;
  };
  using Points = std::span<const Point<dim>>;

  static MiddleNode middle_of_face(NodeIndex node, std::span<const NodeIndex> corners,
                                   std::span<const NodeIndex> midside, std::size_t face);
  Point<dim> straight(const EdgeNode& edge, Points x) const {
    return 0.5 * (x[edge.a] + x[edge.b]);
  }
  Point<dim> straight(const MiddleNode& middle, Points x) const;
  bool has_moved(const EdgeNode& edge, Points x) const {
    return x[edge.a] != initial_[edge.a] || x[edge.b] != initial_[edge.b];
  }
  bool has_moved(const MiddleNode& middle, Points x) const;
  /// Returns the vector that a node's offset turns and scales with.
  static Point<dim> direction(const EdgeNode& edge, Points x) { return x[edge.b] - x[edge.a]; }
  static Point<dim> direction(const MiddleNode& middle, Points x) {
    return x[middle.corners[middle.corners.size() == 3 ? 1 : 2]] - x[middle.corners[0]];
  }

  static const Point<dim>& a_corner_of(const EdgeNode& edge, Points x) { return x[edge.a]; }
  static const Point<dim>& a_corner_of(const MiddleNode& middle, Points x) {
    return x[middle.corners[0]];
  }

  /// Calls visit(node) for all midside nodes in an order in which each depends on earlier ones.
  template <class Visit>
  void for_each_node(const Visit& visit) const;
  /// The same; visit(node) may write to what belongs to this node only.
  template <class Visit>
  void for_each_node_in_parallel(const Visit& visit) const;
  /// Returns the straight place of a node plus a part of its initial offset.
  template <class Node>
  Point<dim> bent(const Node& node, Points x, double part) const;
  /// Sets is_bent_ and curved_cells_.
  void find_bent_nodes();
  /// True if the mesh's constraints keep the node on a surface.
  bool slides(NodeIndex node) const {
    return constraints_ &&
           constraints_->classifications()[node].kind != GeometricClassification::none;
  }
  bool any_slides(CellIndex c) const {
    const auto midside = topology_->midside_nodes(c);
    return constraints_ && std::any_of(midside.begin(), midside.end(),
                                       [&](NodeIndex node) { return slides(node); });
  }
  /// True for a triangle or tetrahedron whose midside nodes are at their straight places.
  bool is_straight_simplex(CellIndex c, std::span<const std::uint8_t> is_bent) const;
  /// Returns the mean ratio of each curved cell. is_bent: flags of midside nodes that are not at
  /// their straight places.
  std::vector<double> qualities(const Mesh<dim>& mesh,
                                const std::vector<std::uint8_t>& is_bent) const;
  /// Places all nodes. quarters: by node, the part of the initial curvature that it keeps. Returns
  /// flags of the nodes that are not at their straight places.
  std::vector<std::uint8_t> place_all(Mesh<dim>& mesh,
                                      std::span<const std::uint8_t> quarters) const;

  std::vector<Point<dim>> initial_;
  std::shared_ptr<const Topology> topology_, without_midside_;
  std::shared_ptr<const NodeConstraints<dim>> constraints_;
  std::vector<EdgeNode> edges_;
  std::vector<MiddleNode> middles_;      ///< of faces, then of cells
  std::vector<std::uint8_t> is_bent_;    ///< by node: is not at its straight place
  std::vector<CellIndex> curved_cells_;  ///< of second order, without simplices that stay straight
};

/// Makes curved cells valid, as MidsidePlacement::repair() does.
template <int dim>
MidsideReport repair_midside_nodes(Mesh<dim>& mesh) {
  std::vector<double> ignored;
  return MidsidePlacement<dim>(mesh).repair(mesh, ignored);
}

}  // namespace smoothfem
