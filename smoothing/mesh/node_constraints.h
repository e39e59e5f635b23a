// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Part of a surface that a node may slide on: the smooth part (patch) or the feature line of this
/// number. Curves in the plane have lines and corners only.
struct GeometricClassification {
  enum Kind : std::uint8_t { none, patch, line, corner };
  Kind kind = none;  ///< none: not a node of the surface; corner: it stays
  std::uint32_t part = 0;

  /// Returns the number of directions in which a node may move; spacedim if it moves freely.
  int n_directions(int spacedim) const {
    return kind == none ? spacedim : kind == patch ? 2 : kind == line ? 1 : 0;
  }
};

/// Keeps nodes of a mesh on a surface in space or on curves in the plane, and bounds the distance
/// of its facets from them. This is the interface for meshes, qualities and smoothers;
/// smoothing/surface implements it. Below, "surface" also means curves. Immutable; may be used by
/// several threads at a time.
template <int spacedim>
class NodeConstraints {
 public:
  using PointType = Point<spacedim>;
  static constexpr double unbounded = std::numeric_limits<double>::infinity();

  virtual ~NodeConstraints() = default;

  /// Returns the position of a node that is at `from` and should move to `wanted`: the nearest
  /// point of the node's part of the surface. A node that is not of the surface moves to `wanted`
  /// itself. A corner stays, and so does any node with wanted == from. The search is faster if
  /// `from` is closer.
  virtual PointType project(NodeIndex node, const PointType& from,
                            const PointType& wanted) const = 0;

  /// Returns the distance of a point from the surface.
  virtual double distance(const PointType& point) const = 0;

  /// Returns the largest distance of facets from the surface, measured at their midpoints and those
  /// of their sides; `unbounded` if there is no limit.
  virtual double facet_bound() const = 0;
  /// Returns the largest such distance of the facets between nodes with these coordinates.
  virtual double facet_distance(std::span<const PointType> coordinates) const = 0;
  /// Returns the facets that are farther off than the bound, ascending: all, or those around some
  /// nodes.
  virtual std::vector<std::uint32_t> facets_out_of_bound(
      std::span<const PointType> coordinates) const = 0;
  virtual std::vector<std::uint32_t> facets_out_of_bound(
      std::span<const PointType> coordinates, std::span<const NodeIndex> around) const = 0;
  /// True if no facet around these nodes is farther off than the bound.
  virtual bool keeps_bound(std::span<const PointType> coordinates,
                           std::span<const NodeIndex> around) const = 0;
  virtual std::span<const NodeIndex> facet_nodes(std::uint32_t facet) const = 0;

  /// Returns the classification of each node.
  virtual std::span<const GeometricClassification> classifications() const = 0;
  bool is_corner(NodeIndex node) const {
    return classifications()[node].kind == GeometricClassification::corner;
  }
  /// Returns the unit normals of the facets of the initial surface; zero for facets without area,
  /// empty for curves. The facets of a surface mesh are its cells.
  virtual std::span<const PointType> facet_normals() const { return {}; }
};

/// Returns the position that a free node may take if it should move to `wanted`: `wanted` itself,
/// or its projection by the mesh's constraints.
template <int dim, int spacedim>
Point<spacedim> allowed_position(const Mesh<dim, spacedim>& mesh, NodeIndex node,
                                 const Point<spacedim>& wanted) {
  if (const auto* constraints = mesh.constraints()) [[unlikely]]
    return constraints->project(node, mesh.coordinates()[node], wanted);
  return wanted;
}

/// True if the mesh has a bound for the distance of its facets.
template <int dim, int spacedim>
bool has_facet_bound(const Mesh<dim, spacedim>& mesh) {
  return mesh.constraints() &&
         mesh.constraints()->facet_bound() < NodeConstraints<spacedim>::unbounded;
}

/// True if the facets around these nodes keep the mesh's bound, or if it has none.
template <int dim, int spacedim>
bool keeps_facet_bound(const Mesh<dim, spacedim>& mesh, std::span<const NodeIndex> around) {
  return !mesh.constraints() || mesh.constraints()->keeps_bound(mesh.coordinates(), around);
}

}  // namespace smoothfem
