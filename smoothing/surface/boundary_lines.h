// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/optimization/sliding_nodes.h"
#include "smoothing/surface/surface_constraints.h"

namespace smoothfem {

/// The boundary of a planar mesh in its present state, for nodes that slide along it. Nodes where
/// it turns by more than the feature angle are corners, which stay.
class BoundaryLines final : public SlidingNodes<2> {
 public:
  /// slide_distance: largest distance of the midpoints of boundary edges from the initial boundary,
  /// as a fraction of its mean edge length. Above 0; infinity means no limit. Throws InputError
  /// otherwise, and as find_features does.
  BoundaryLines(const PlanarMesh& mesh, const FeatureParameters& parameters, double slide_distance);

  bool is_corner(NodeIndex node) const;
  int n_directions(NodeIndex node) const override;
  Point<2> project(NodeIndex node, const Point<2>& from, const Point<2>& wanted) const override;
  bool keeps_bound(std::span<const Point<2>> x, NodeIndex node) const override;

  double edge_bound() const { return edge_bound_; }
  /// Returns the largest distance of the midpoint of a boundary edge from the initial boundary. x:
  /// of all nodes.
  double edge_distance(std::span<const Point<2>> x) const;

 private:
  double distance(std::span<const NodeIndex> edge, std::span<const Point<2>> x) const;

  std::shared_ptr<const Topology> topology_;
  std::vector<NodeIndex> wall_nodes_;  ///< wall node of each of the mesh's nodes; absent inside
  CompressedRows<std::uint32_t> node_edges_;
  double edge_bound_ = 0.0;
  std::unique_ptr<const SurfaceConstraints> wall_;  ///< the wall that stands on the boundary
};

}  // namespace smoothfem
