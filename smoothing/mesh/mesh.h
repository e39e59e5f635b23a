// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cassert>
#include <memory>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "smoothing/base/input_error.h"
#include "smoothing/mesh/point.h"
#include "smoothing/mesh/topology.h"

namespace smoothfem {

class NodeConstraints;  // smoothing/mesh/node_constraints.h

/// Throws InputError that names the first node with a coordinate that is no finite number.
template <class PointType>
void require_finite(const std::vector<PointType>& coordinates) {
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (!coordinates[i].allFinite())
      throw InputError("node " + std::to_string(i) +
                       " has a coordinate that is not a finite number");
}

/// A mesh of dim-dimensional cells in spacedim-dimensional space: a topology that never changes,
/// shared by all copies, and coordinates that do, one point per node as long as the mesh lives. A
/// value: copies are independent, and one that was moved from is good for assignment only. Its
/// nodes may belong to a surface in space that they must not leave, the same for all copies; those
/// of surface meshes always do.
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

  /// A mesh of points that are known to be finite, or have been taken from another mesh: nothing is
  /// looked at.
  static Mesh of_known_points(std::shared_ptr<const Topology> topology,
                              std::vector<PointType> coordinates) noexcept {
    return Mesh(std::move(topology), std::move(coordinates), nullptr, KnownPoints{});
  }

  const Topology& topology() const { return *topology_; }
  const std::shared_ptr<const Topology>& shared_topology() const { return topology_; }

  std::size_t n_nodes() const { return topology_->n_nodes(); }
  std::size_t n_cells() const { return topology_->n_cells(); }

  std::span<const PointType> coordinates() const { return coordinates_; }
  std::span<PointType> coordinates() { return coordinates_; }
  std::vector<PointType> copied_coordinates() const {
    return {coordinates_.begin(), coordinates_.end()};
  }
  /// Copies n_nodes() points into the mesh.
  void set_coordinates(std::span<const PointType> points) {
    assert(points.size() == n_nodes());
    std::copy(points.begin(), points.end(), coordinates_.begin());
  }
  /// Exchanges the coordinates with n_nodes() points.
  void swap_coordinates(std::vector<PointType>& points) {
    assert(points.size() == n_nodes());
    coordinates_.swap(points);
  }
  /// The coordinates of a mesh that is not needed any more: std::move(mesh).take_coordinates().
  std::vector<PointType> take_coordinates() && { return std::move(coordinates_); }

  /// Null if nodes may go anywhere.
  const NodeConstraints* constraints() const { return constraints_.get(); }
  const std::shared_ptr<const NodeConstraints>& shared_constraints() const { return constraints_; }

 private:
  struct KnownPoints {};
  Mesh(std::shared_ptr<const Topology> topology, std::vector<PointType> coordinates,
       std::shared_ptr<const NodeConstraints> constraints, KnownPoints) noexcept
      : topology_(std::move(topology)),
        coordinates_(std::move(coordinates)),
        constraints_(std::move(constraints)) {
    assert(coordinates_.size() == topology_->n_nodes());
  }

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

/// `visit.operator()<dim, spacedim>()` for dimensions that are known only now.
template <class Visit>
decltype(auto) with_dimensions(MeshDimensions dimensions, const Visit& visit) {
  if (dimensions.cells == 3) return visit.template operator()<3, 3>();
  return dimensions.space == 3 ? visit.template operator()<2, 3>()
                               : visit.template operator()<2, 2>();
}

/// `visit.operator()<dim>()` for a dimension that is known only now: 2 or 3.
template <class Visit>
decltype(auto) with_dimension(int dim, const Visit& visit) {
  return dim == 2 ? visit.template operator()<2>() : visit.template operator()<3>();
}

}  // namespace smoothfem
