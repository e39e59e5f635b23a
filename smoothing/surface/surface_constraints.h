// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "smoothing/mesh/node_constraints.h"
#include "smoothing/surface/surface_features.h"

namespace smoothfem {

class PieceIndex;  // smoothing/surface/piece_index.h

/// Keeps nodes on their part of a surface: nodes of smooth parts on these, nodes of a feature line
/// on the line, corners at their positions (thesis, Section 5.1.2). The surface is its initial
/// mesh; a linear facet with more than three nodes becomes triangles around the mean of its nodes,
/// and a facet of second order is the image of its shape functions (nearest points by Newton). Only
/// the node's own smooth part or line counts, so that it cannot change over to another sheet of the
/// surface. Facets between moved nodes cut across curved parts; their distance may be bounded, too.
class SurfaceConstraints final : public NodeConstraints<3> {
 public:
  /// facets: the initial mesh of a surface of nodes with these coordinates. facet_bound: largest
  /// distance of facets from the surface, above 0. Throws InputError as find_features does.
  SurfaceConstraints(const SurfaceFacets& facets, std::span<const Point<3>> coordinates,
                     const FeatureParameters& parameters = {}, double facet_bound = unbounded);
  ~SurfaceConstraints() override;

  Point<3> project(NodeIndex node, const Point<3>& from, const Point<3>& wanted) const override;

  double distance(const Point<3>& point) const override;

  double facet_bound() const override { return facet_bound_; }
  double facet_distance(std::span<const Point<3>> coordinates) const override;
  std::vector<std::uint32_t> facets_out_of_bound(
      std::span<const Point<3>> coordinates) const override;
  std::vector<std::uint32_t> facets_out_of_bound(std::span<const Point<3>> coordinates,
                                                 std::span<const NodeIndex> around) const override;
  bool keeps_bound(std::span<const Point<3>> coordinates,
                   std::span<const NodeIndex> around) const override;
  std::span<const NodeIndex> facet_nodes(std::uint32_t facet) const override {
    return facets_[facet];
  }

  std::span<const GeometricClassification> classifications() const override {
    return features_.classifications;
  }
  std::span<const Point<3>> facet_normals() const override { return facet_normals_; }

 private:
  /// radius: where the search begins.
  double distance(const Point<3>& point, double radius) const;
  /// Returns the facets around these nodes, ascending; none if there is no bound.
  std::vector<std::uint32_t> facets_of(std::span<const NodeIndex> around) const;
  bool is_out_of_bound(std::uint32_t facet, std::span<const Point<3>> coordinates) const;

  SurfaceFeatures features_;
  CompressedRows<NodeIndex> facets_;
  CompressedRows<std::uint32_t> node_facets_;
  double facet_bound_;
  std::vector<Point<3>> facet_normals_;
  std::unique_ptr<const PieceIndex> triangles_, segments_;
};

/// Throws InputError unless the distance is above 0; infinity is allowed.
void require_slide_distance(double slide_distance);

/// Makes a mesh of the surface that these cells form; its nodes never leave it. Features follow
/// from the parameters, tags of the cells and labelled edges. Corners are fixed, and so are the
/// nodes with a flag in `fixed` (one for each node). Throws InputError as Topology and
/// NodeConstraints do.
SurfaceMesh make_surface_mesh(CompressedRows<NodeIndex> cells, std::vector<Point<3>> coordinates,
                              MeshLabels labels = {}, std::optional<std::vector<bool>> fixed = {},
                              const FeatureParameters& parameters = {});

/// Returns the mesh with other features; its present nodes become the initial ones.
SurfaceMesh with_features(const SurfaceMesh& mesh, const FeatureParameters& parameters);

}  // namespace smoothfem
