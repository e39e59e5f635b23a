// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Which part of a surface a node may slide on: the smooth part (patch) or the feature line of this
/// number.
struct GeometricClassification {
  enum Kind : std::uint8_t { none, patch, line, corner };
  Kind kind = none;  ///< none: not a node of the surface; corner: it stays
  std::uint32_t part = 0;
};

/// Keeps nodes of a mesh on a surface in space, and bounds how far its facets come off it. What a
/// mesh, its quality and the smoothers have to know of a surface; smoothing/surface implements it.
/// Immutable; any number of threads may ask at a time.
class NodeConstraints {
 public:
  static constexpr double unbounded = std::numeric_limits<double>::infinity();

  virtual ~NodeConstraints() = default;

  /// Where a node that is at `from` and should go to `wanted` comes to lie: at the nearest point of
  /// the part of the surface that it belongs to; at `wanted` itself if it is not on the surface,
  /// and where it is if it is a corner or wanted == from. The nearer `from` is, the faster.
  virtual Point<3> project(NodeIndex node, const Point<3>& from, const Point<3>& wanted) const = 0;

  /// Distance of a point from the surface.
  virtual double distance(const Point<3>& point) const = 0;

  /// The largest distance from the surface that facets may have, at their middles and those of
  /// their sides; `unbounded` if there is none.
  virtual double facet_bound() const = 0;
  /// How far the facets between nodes with these coordinates are off the surface, likewise.
  virtual double facet_distance(std::span<const Point<3>> coordinates) const = 0;
  /// The facets that are farther off than the bound, ascending: of all, or of those around nodes.
  virtual std::vector<std::uint32_t> facets_out_of_bound(
      std::span<const Point<3>> coordinates) const = 0;
  virtual std::vector<std::uint32_t> facets_out_of_bound(
      std::span<const Point<3>> coordinates, std::span<const NodeIndex> around) const = 0;
  /// True if no facet around these nodes is.
  virtual bool keeps_bound(std::span<const Point<3>> coordinates,
                           std::span<const NodeIndex> around) const = 0;
  virtual std::span<const NodeIndex> facet_nodes(std::uint32_t facet) const = 0;

  /// Of each node.
  virtual std::span<const GeometricClassification> classifications() const = 0;
  bool is_corner(NodeIndex node) const {
    return classifications()[node].kind == GeometricClassification::corner;
  }
  /// Unit normals of the facets of the initial surface; zero for those without area. For a surface
  /// mesh its facets are its cells.
  virtual std::span<const Point<3>> facet_normals() const = 0;
};

/// The position that a free node of a mesh which should go to `wanted` may take: `wanted`, or where
/// the mesh's constraints have it.
template <int dim, int spacedim>
Point<spacedim> allowed_position(const Mesh<dim, spacedim>& mesh, NodeIndex node,
                                 const Point<spacedim>& wanted) {
  if constexpr (spacedim == 3)
    if (const NodeConstraints* constraints = mesh.constraints())
      return constraints->project(node, mesh.coordinates()[node], wanted);
  return wanted;
}

/// True if facets of the mesh have a bound to keep.
template <int dim, int spacedim>
bool has_facet_bound(const Mesh<dim, spacedim>& mesh) {
  if constexpr (spacedim == 3)
    return mesh.constraints() && mesh.constraints()->facet_bound() < NodeConstraints::unbounded;
  return false;
}

/// True if the facets around these nodes keep the bound that the mesh has for them, if any.
template <int dim, int spacedim>
bool keeps_facet_bound(const Mesh<dim, spacedim>& mesh, std::span<const NodeIndex> around) {
  if constexpr (spacedim == 3)
    return !mesh.constraints() || mesh.constraints()->keeps_bound(mesh.coordinates(), around);
  return true;
}

}  // namespace smoothfem
