#pragma once

#include <Eigen/Core>
#include <cassert>
#include <memory>
#include <variant>
#include <vector>

#include "smoothing/base/input_error.h"
#include "smoothing/mesh/topology.h"

namespace smoothfem {

template <int spacedim>
using Point = Eigen::Matrix<double, spacedim, 1>;

class NodeConstraints;  // smoothing/surface/node_constraints.h

/// Throws InputError that names the first node with a coordinate that is no finite number.
template <class PointType>
void require_finite(const std::vector<PointType>& coordinates) {
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (!coordinates[i].allFinite())
      throw InputError("node " + std::to_string(i) +
                       " has a coordinate that is not a finite number");
}

/// A mesh of dim-dimensional cells in spacedim-dimensional space: a topology that never changes,
/// shared by all copies, and coordinates that do. A value: copies are independent. Its nodes may
/// belong to a surface in space that they must not leave, the same for all copies; those of surface
/// meshes always do.
template <int dim, int spacedim = dim>
class Mesh {
 public:
  using PointType = Point<spacedim>;

  /// topology: of dimension dim. coordinates: topology->n_nodes() finite points. Throws InputError
  /// otherwise, naming the node. constraints: of these nodes; a surface mesh needs them, and a
  /// planar one has none.
  Mesh(std::shared_ptr<const Topology> topology, std::vector<PointType> coordinates,
       std::shared_ptr<const NodeConstraints> constraints = nullptr)
      : topology_(std::move(topology)),
        coordinates_(std::move(coordinates)),
        constraints_(std::move(constraints)) {
    assert(spacedim == 3 ? dim == 3 || constraints_ : !constraints_);
    if (topology_->dimension() != dim)
      throw InputError("a mesh of dimension " + std::to_string(dim) +
                       " cannot have cells of dimension " + std::to_string(topology_->dimension()));
    if (coordinates_.size() != topology_->n_nodes())
      throw InputError("the mesh has " + std::to_string(topology_->n_nodes()) + " nodes but " +
                       std::to_string(coordinates_.size()) + " coordinates");
    require_finite(coordinates_);
  }

  const Topology& topology() const { return *topology_; }
  const std::shared_ptr<const Topology>& shared_topology() const { return topology_; }

  std::size_t n_nodes() const { return coordinates_.size(); }
  std::size_t n_cells() const { return topology_->n_cells(); }

  const std::vector<PointType>& coordinates() const { return coordinates_; }
  std::vector<PointType>& coordinates() { return coordinates_; }

  /// Null if nodes may go anywhere.
  const NodeConstraints* constraints() const { return constraints_.get(); }
  const std::shared_ptr<const NodeConstraints>& shared_constraints() const { return constraints_; }

 private:
  std::shared_ptr<const Topology> topology_;
  std::vector<PointType> coordinates_;
  std::shared_ptr<const NodeConstraints> constraints_;
};

using PlanarMesh = Mesh<2>;
using VolumeMesh = Mesh<3>;
using SurfaceMesh = Mesh<2, 3>;
using AnyMesh = std::variant<PlanarMesh, VolumeMesh, SurfaceMesh>;

/// What users call meshes of these dimensions.
constexpr const char* mesh_kind_name(int dim, int spacedim) {
  return spacedim > dim ? "surface" : dim == 2 ? "planar" : "volume";
}

inline const char* kind_name(const AnyMesh& mesh) {
  return std::visit([]<int dim, int spacedim>(
                        const Mesh<dim, spacedim>&) { return mesh_kind_name(dim, spacedim); },
                    mesh);
}

/// Dimensions of a mesh's cells and of the space it is in: planar, volume and surface meshes have
/// (2, 2), (3, 3) and (2, 3).
struct MeshDimensions {
  int cells = 2, space = 2;
};

/// visit.operator()<dim, spacedim>() for dimensions that are known only now.
template <class Visit>
decltype(auto) with_dimensions(MeshDimensions dimensions, const Visit& visit) {
  if (dimensions.cells == 3) return visit.template operator()<3, 3>();
  return dimensions.space == 3 ? visit.template operator()<2, 3>()
                               : visit.template operator()<2, 2>();
}

/// visit.operator()<dim>() for a dimension that is known only now: 2 or 3.
template <class Visit>
decltype(auto) with_dimension(int dim, const Visit& visit) {
  return dim == 2 ? visit.template operator()<2>() : visit.template operator()<3>();
}

}  // namespace smoothfem
