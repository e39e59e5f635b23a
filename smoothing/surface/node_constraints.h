#pragma once

#include <memory>
#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/surface/surface_features.h"

namespace smoothfem {

/// Keeps nodes where they belong on a surface: those of its smooth parts on them, those of a
/// feature line on it, corners where they are (thesis, Section 5.1.2). The surface is the initial
/// mesh of it, a facet of more than three nodes seen as triangles around the mean of its nodes; a
/// node's own smooth part or line counts only, so that it cannot change over to another sheet of
/// the surface. Immutable; any number of threads may ask at a time.
class NodeConstraints {
 public:
  /// facets: a surface of nodes with these coordinates, its initial mesh. Throws InputError as
  /// find_features does.
  NodeConstraints(const SurfaceFacets& facets, std::vector<Point<3>> coordinates,
                  const FeatureParameters& parameters = {});
  ~NodeConstraints();

  /// Where a node that is at `from` and should go to `wanted` comes to lie: at the nearest point of
  /// its carrier; at `wanted` itself if it is not on the surface, and where it is if it is a corner
  /// or wanted == from. `from` is where the search begins, the nearer the faster.
  Point<3> project(NodeIndex node, const Point<3>& from, const Point<3>& wanted) const;

  /// Distance of a point from the initial surface.
  double distance(const Point<3>& point) const;

  const std::vector<NodeCarrier>& carriers() const { return features_.carriers; }
  bool is_corner(NodeIndex node) const {
    return features_.carriers[node].kind == NodeCarrier::corner;
  }
  /// Unit normals of the facets of the initial surface; zero for those without area.
  const std::vector<Point<3>>& facet_normals() const { return facet_normals_; }

 private:
  class Index;

  SurfaceFeatures features_;
  std::vector<Point<3>> facet_normals_;
  std::unique_ptr<const Index> triangles_, segments_;
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

/// A mesh of the surface that these cells are, which its nodes never leave: its features follow
/// from the parameters, tags of the cells and labelled edges. Corners are fixed, and the nodes that
/// `fixed` names (one flag a node). Throws InputError as Topology and NodeConstraints do.
SurfaceMesh make_surface_mesh(CompressedRows<NodeIndex> cells, std::vector<Point<3>> coordinates,
                              MeshLabels labels = {}, std::optional<std::vector<bool>> fixed = {},
                              const FeatureParameters& parameters = {});

/// The same mesh, its present nodes taken for the initial ones, with other features.
SurfaceMesh with_features(const SurfaceMesh& mesh, const FeatureParameters& parameters);

}  // namespace smoothfem
