// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/optimization/sliding_nodes.h"
#include "smoothing/surface/surface_constraints.h"

namespace smoothfem {

/// The boundary of a planar mesh, as it is now, for nodes that slide along it: a node that more
/// than the feature angle turns at is a corner, which stays.
class BoundaryLines final : public SlidingNodes<2> {
 public:
  /// slide_distance: the middles of boundary edges come off the initial boundary by no more than
  /// this fraction of its mean edge length; above 0, infinity is no bound. Throws InputError
  /// otherwise, and as find_features does.
  BoundaryLines(const PlanarMesh& mesh, const FeatureParameters& parameters, double slide_distance);

  bool is_corner(NodeIndex node) const;
  int n_directions(NodeIndex node) const override;
  Point<2> project(NodeIndex node, const Point<2>& from, const Point<2>& wanted) const override;
  bool keeps_bound(std::span<const Point<2>> x, NodeIndex node) const override;

  double edge_bound() const { return edge_bound_; }
  /// The largest distance of the middle of a boundary edge from the initial boundary. x: of all
  /// nodes.
  double edge_distance(std::span<const Point<2>> x) const;

 private:
  double distance(std::span<const NodeIndex> edge, std::span<const Point<2>> x) const;

  std::shared_ptr<const Topology> topology_;
  std::vector<NodeIndex> wall_nodes_;  ///< of the mesh's nodes; absent inside
  CompressedRows<std::uint32_t> node_edges_;
  double edge_bound_ = 0.0;
  std::unique_ptr<const SurfaceConstraints> wall_;  ///< that stands on the boundary
};

}  // namespace smoothfem
