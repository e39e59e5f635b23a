// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "smoothing/mesh/node_constraints.h"
#include "smoothing/surface/surface_constraints.h"

namespace smoothfem {

/// Keeps nodes on curves in the plane: the boundary of a planar mesh, interfaces, or both. Corners
/// are nodes where a curve turns by more than the feature angle, where other than two edges meet,
/// and where edges of different tags meet.
class LineConstraints final : public NodeConstraints<2> {
 public:
  /// edges: the initial curves; their facets have two nodes, and marked_edges is not used.
  /// coordinates: of all nodes. facet_bound: largest distance of the edges' midpoints from the
  /// curves, above 0. Throws InputError as find_features does.
  LineConstraints(const SurfaceFacets& edges, std::span<const Point<2>> coordinates,
                  const FeatureParameters& parameters = {}, double facet_bound = unbounded);

  Point<2> project(NodeIndex node, const Point<2>& from, const Point<2>& wanted) const override;

  double distance(const Point<2>& point) const override;

  double facet_bound() const override { return facet_bound_; }
  double facet_distance(std::span<const Point<2>> coordinates) const override;
  std::vector<std::uint32_t> facets_out_of_bound(
      std::span<const Point<2>> coordinates) const override;
  std::vector<std::uint32_t> facets_out_of_bound(std::span<const Point<2>> coordinates,
                                                 std::span<const NodeIndex> around) const override;
  bool keeps_bound(std::span<const Point<2>> coordinates,
                   std::span<const NodeIndex> around) const override;
  std::span<const NodeIndex> facet_nodes(std::uint32_t facet) const override {
    return edges_[facet];
  }

  std::span<const GeometricClassification> classifications() const override {
    return classifications_;
  }

 private:
  double distance_of(std::uint32_t edge, std::span<const Point<2>> coordinates) const;
  bool is_out_of_bound(std::uint32_t edge, std::span<const Point<2>> coordinates) const {
    return !(distance_of(edge, coordinates) <= facet_bound_);
  }

  CompressedRows<NodeIndex> edges_;
  CompressedRows<std::uint32_t> node_edges_;
  double facet_bound_;
  std::vector<NodeIndex> wall_nodes_;  ///< node of the wall below each node; absent elsewhere
  std::unique_ptr<const SurfaceConstraints> wall_;  ///< the wall that stands on the curves
  std::vector<GeometricClassification> classifications_;
};

}  // namespace smoothfem
