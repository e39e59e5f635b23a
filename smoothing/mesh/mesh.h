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

template <int spacedim>
class NodeConstraints;  // smoothing/mesh/node_constraints.h
template <int dim>
class CellTargets;  // smoothing/quality/cell_targets.h

/// Throws InputError that names the first node with a non-finite coordinate.
template <class PointType>
void require_finite(const std::vector<PointType>& coordinates) {
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (!coordinates[i].allFinite())
      throw InputError("node " + std::to_string(i) +
                       " has a coordinate that is not a finite number");
}

/// A mesh of dim-dimensional cells in spacedim-dimensional space. All copies share a topology,
/// which never changes. The coordinates may change; the number of points may not. A value type:
/// copies are independent, and a moved-from mesh may only be assigned to. Constraints may keep its
/// nodes on a surface in space or on curves in the plane, the same for all copies; surface meshes
/// always have them. Planar and volume meshes may have a target shape and size for each cell.
template <int dim, int spacedim = dim>
class Mesh {
 public:
  using PointType = Point<spacedim>;

  /// topology: of dimension dim. coordinates: topology->n_nodes() finite points. Otherwise throws
  /// InputError that names the node. constraints: of these nodes; required for surface meshes.
  /// targets: of these cells; null: regular elements of any size.
  Mesh(std::shared_ptr<const Topology> topology, std::vector<PointType> coordinates,
       std::shared_ptr<const NodeConstraints<spacedim>> constraints = nullptr,
       std::shared_ptr<const CellTargets<dim>> targets = nullptr)
      : topology_(std::move(topology)),
        coordinates_(std::move(coordinates)),
        constraints_(std::move(constraints)),
        targets_(std::move(targets)) {
    assert(spacedim == dim ? true : constraints_ && !targets_);
    if (topology_->dimension() != dim)
      throw InputError("a mesh of dimension " + std::to_string(dim) +
                       " cannot have cells of dimension " + std::to_string(topology_->dimension()));
    if (coordinates_.size() != topology_->n_nodes())
      throw InputError("the mesh has " + std::to_string(topology_->n_nodes()) + " nodes but " +
                       std::to_string(coordinates_.size()) + " coordinates");
    require_finite(coordinates_);
  }

  /// Makes a mesh of points that are known to be finite, for example those of another mesh. Checks
  /// nothing.
  static Mesh from_finite_points(std::shared_ptr<const Topology> topology,
                                 std::vector<PointType> coordinates) noexcept {
    return Mesh(std::move(topology), std::move(coordinates), KnownPoints{});
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
  /// Moves the coordinates out of a mesh that is not needed any more:
  /// std::move(mesh).take_coordinates().
  std::vector<PointType> take_coordinates() && { return std::move(coordinates_); }

  /// Returns the constraints; null if nodes may move anywhere.
  const NodeConstraints<spacedim>* constraints() const { return constraints_.get(); }
  const std::shared_ptr<const NodeConstraints<spacedim>>& shared_constraints() const {
    return constraints_;
  }

  /// Returns the targets of the cells; null if these are regular elements of any size.
  const CellTargets<dim>* targets() const { return targets_.get(); }
  const std::shared_ptr<const CellTargets<dim>>& shared_targets() const { return targets_; }

 private:
  struct KnownPoints {};
  Mesh(std::shared_ptr<const Topology> topology, std::vector<PointType> coordinates,
       KnownPoints) noexcept
      : topology_(std::move(topology)), coordinates_(std::move(coordinates)) {
    assert(coordinates_.size() == topology_->n_nodes());
  }

  std::shared_ptr<const Topology> topology_;
  std::vector<PointType> coordinates_;
  std::shared_ptr<const NodeConstraints<spacedim>> constraints_;
  std::shared_ptr<const CellTargets<dim>> targets_;
};

using PlanarMesh = Mesh<2>;
using VolumeMesh = Mesh<3>;
using SurfaceMesh = Mesh<2, 3>;
using AnyMesh = std::variant<PlanarMesh, VolumeMesh, SurfaceMesh>;

/// Returns the users' name for meshes of these dimensions.
constexpr const char* mesh_kind_name(int dim, int spacedim) {
  return spacedim > dim ? "surface" : dim == 2 ? "planar" : "volume";
}

inline const char* kind_name(const AnyMesh& mesh) {
  return std::visit([]<int dim, int spacedim>(
                        const Mesh<dim, spacedim>&) { return mesh_kind_name(dim, spacedim); },
                    mesh);
}

/// Dimensions of a mesh's cells and of its space: (2, 2) for planar, (3, 3) for volume and (2, 3)
/// for surface meshes.
struct MeshDimensions {
  int cells = 2, space = 2;
};

/// Calls `visit.operator()<dim, spacedim>()` for dimensions that are known only at run time.
template <class Visit>
decltype(auto) with_dimensions(MeshDimensions dimensions, const Visit& visit) {
  if (dimensions.cells == 3) return visit.template operator()<3, 3>();
  return dimensions.space == 3 ? visit.template operator()<2, 3>()
                               : visit.template operator()<2, 2>();
}

/// Calls `visit.operator()<dim>()` for a dimension (2 or 3) that is known only at run time.
template <class Visit>
decltype(auto) with_dimension(int dim, const Visit& visit) {
  return dim == 2 ? visit.template operator()<2>() : visit.template operator()<3>();
}

}  // namespace smoothfem
