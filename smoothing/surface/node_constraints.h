#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/surface/surface_features.h"

namespace smoothfem {

class PieceIndex;  // smoothing/surface/piece_index.h

/// Keeps nodes where they belong on a surface: those of its smooth parts on them, those of a
/// feature line on it, corners where they are (thesis, Section 5.1.2). The surface is the initial
/// mesh of it, a facet of more than three nodes seen as triangles around the mean of its nodes; a
/// node's own smooth part or line counts only, so that it cannot change over to another sheet of
/// the surface. Facets between moved nodes cut across what is curved; they may be bounded, too.
/// Immutable; any number of threads may ask at a time.
class NodeConstraints {
 public:
  static constexpr double unbounded = std::numeric_limits<double>::infinity();

  /// facets: a surface of nodes with these coordinates, its initial mesh. facet_bound: how far
  /// facets may come off it, above 0. Throws InputError as find_features does.
  NodeConstraints(const SurfaceFacets& facets, const std::vector<Point<3>>& coordinates,
                  const FeatureParameters& parameters = {}, double facet_bound = unbounded);
  ~NodeConstraints();

  /// Where a node that is at `from` and should go to `wanted` comes to lie: at the nearest point of
  /// its carrier; at `wanted` itself if it is not on the surface, and where it is if it is a corner
  /// or wanted == from. `from` is where the search begins, the nearer the faster.
  Point<3> project(NodeIndex node, const Point<3>& from, const Point<3>& wanted) const;

  /// Distance of a point from the initial surface.
  double distance(const Point<3>& point) const;

  /// How far the facets between nodes at these coordinates are off the initial surface: at their
  /// middles and those of their sides.
  double facet_distance(const std::vector<Point<3>>& coordinates) const;
  double facet_bound() const { return facet_bound_; }
  /// The facets that are farther off than the bound, ascending: of all, or of those around nodes.
  std::vector<std::uint32_t> facets_out_of_bound(const std::vector<Point<3>>& coordinates) const;
  std::vector<std::uint32_t> facets_out_of_bound(const std::vector<Point<3>>& coordinates,
                                                 std::span<const NodeIndex> around) const;
  /// True if no facet around these nodes is; ends at the first one that is.
  bool keeps_bound(const std::vector<Point<3>>& coordinates,
                   std::span<const NodeIndex> around) const;
  std::span<const NodeIndex> facet_nodes(std::uint32_t facet) const { return facets_[facet]; }

  const std::vector<NodeCarrier>& carriers() const { return features_.carriers; }
  bool is_corner(NodeIndex node) const {
    return features_.carriers[node].kind == NodeCarrier::corner;
  }
  /// Unit normals of the facets of the initial surface; zero for those without area.
  const std::vector<Point<3>>& facet_normals() const { return facet_normals_; }

 private:
  /// radius: where the search begins.
  double distance(const Point<3>& point, double radius) const;
  /// Around these nodes, ascending; none where there is no bound.
  std::vector<std::uint32_t> facets_of(std::span<const NodeIndex> around) const;
  bool is_out_of_bound(std::uint32_t facet, const std::vector<Point<3>>& coordinates) const;

  SurfaceFeatures features_;
  CompressedRows<NodeIndex> facets_;
  CompressedRows<std::uint32_t> node_facets_;
  double facet_bound_;
  std::vector<Point<3>> facet_normals_;
  std::unique_ptr<const PieceIndex> triangles_, segments_;
};

/// Where a free node of a mesh that should go to `wanted` may go: there, or where the mesh's
/// constraints have it.
template <int dim, int spacedim>
Point<spacedim> allowed_place(const Mesh<dim, spacedim>& mesh, NodeIndex node,
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

/// A mesh of the surface that these cells are, which its nodes never leave: its features follow
/// from the parameters, tags of the cells and labelled edges. Corners are fixed, and the nodes that
/// `fixed` names (one flag a node). Throws InputError as Topology and NodeConstraints do.
SurfaceMesh make_surface_mesh(CompressedRows<NodeIndex> cells, std::vector<Point<3>> coordinates,
                              MeshLabels labels = {}, std::optional<std::vector<bool>> fixed = {},
                              const FeatureParameters& parameters = {});

/// The same mesh, its present nodes taken for the initial ones, with other features.
SurfaceMesh with_features(const SurfaceMesh& mesh, const FeatureParameters& parameters);

}  // namespace smoothfem
