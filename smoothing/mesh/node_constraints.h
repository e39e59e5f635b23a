// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Part of a surface that a node may slide on: the smooth part (patch) or the feature line of this
/// number.
struct GeometricClassification {
  enum Kind : std::uint8_t { none, patch, line, corner };
  Kind kind = none;  ///< none: not a node of the surface; corner: it stays
  std::uint32_t part = 0;
};

/// Keeps nodes of a mesh on a surface in space, and bounds the distance of its facets from it. This
/// is the interface for meshes, qualities and smoothers; smoothing/surface implements it.
/// Immutable; may be used by several threads at a time.
class NodeConstraints {
 public:
  static constexpr double unbounded = std::numeric_limits<double>::infinity();

  virtual ~NodeConstraints() = default;

  /// Returns the position of a node that is at `from` and should move to `wanted`: the nearest
  /// point of the node's part of the surface. A node that is not of the surface moves to `wanted`
  /// itself. A corner stays, and so does any node with wanted == from. The search is faster if
  /// `from` is closer.
  virtual Point<3> project(NodeIndex node, const Point<3>& from, const Point<3>& wanted) const = 0;

  /// Returns the distance of a point from the surface.
  virtual double distance(const Point<3>& point) const = 0;

  /// Returns the largest distance of facets from the surface, measured at their midpoints and those
  /// of their sides; `unbounded` if there is no limit.
  virtual double facet_bound() const = 0;
  /// Returns the largest such distance of the facets between nodes with these coordinates.
  virtual double facet_distance(std::span<const Point<3>> coordinates) const = 0;
  /// Returns the facets that are farther off than the bound, ascending: all, or those around some
  /// nodes.
  virtual std::vector<std::uint32_t> facets_out_of_bound(
      std::span<const Point<3>> coordinates) const = 0;
  virtual std::vector<std::uint32_t> facets_out_of_bound(
      std::span<const Point<3>> coordinates, std::span<const NodeIndex> around) const = 0;
  /// True if no facet around these nodes is farther off than the bound.
  virtual bool keeps_bound(std::span<const Point<3>> coordinates,
                           std::span<const NodeIndex> around) const = 0;
  virtual std::span<const NodeIndex> facet_nodes(std::uint32_t facet) const = 0;

  /// Returns the classification of each node.
  virtual std::span<const GeometricClassification> classifications() const = 0;
  bool is_corner(NodeIndex node) const {
    return classifications()[node].kind == GeometricClassification::corner;
  }
  /// Returns the unit normals of the facets of the initial surface; zero for facets without area.
  /// The facets of a surface mesh are its cells.
  virtual std::span<const Point<3>> facet_normals() const = 0;
};

/// Returns the position that a free node may take if it should move to `wanted`: `wanted` itself,
/// or its projection by the mesh's constraints.
template <int dim, int spacedim>
Point<spacedim> allowed_position(const Mesh<dim, spacedim>& mesh, NodeIndex node,
                                 const Point<spacedim>& wanted) {
  if constexpr (spacedim == 3)
    if (const NodeConstraints* constraints = mesh.constraints())
      return constraints->project(node, mesh.coordinates()[node], wanted);
  return wanted;
}

/// True if the mesh has a bound for the distance of its facets.
template <int dim, int spacedim>
bool has_facet_bound(const Mesh<dim, spacedim>& mesh) {
  if constexpr (spacedim == 3)
    return mesh.constraints() && mesh.constraints()->facet_bound() < NodeConstraints::unbounded;
  return false;
}

/// True if the facets around these nodes keep the mesh's bound, or if it has none.
template <int dim, int spacedim>
bool keeps_facet_bound(const Mesh<dim, spacedim>& mesh, std::span<const NodeIndex> around) {
  if constexpr (spacedim == 3)
    return !mesh.constraints() || mesh.constraints()->keeps_bound(mesh.coordinates(), around);
  return true;
}

}  // namespace smoothfem
