#pragma once

#include <Eigen/Core>
#include <memory>
#include <variant>
#include <vector>

#include "smoothing/mesh/input_error.h"
#include "smoothing/mesh/topology.h"

namespace smoothfem {

template <int spacedim>
using Point = Eigen::Matrix<double, spacedim, 1>;

/// A mesh of dim-dimensional cells in spacedim-dimensional space: a topology that never changes,
/// shared by all copies, and coordinates that do. A value: copies are independent.
template <int dim, int spacedim = dim>
class Mesh {
 public:
  using PointType = Point<spacedim>;

  /// topology: of dimension dim. coordinates: topology->n_nodes() finite points. Throws InputError
  /// otherwise, naming the node.
  Mesh(std::shared_ptr<const Topology> topology, std::vector<PointType> coordinates)
      : topology_(std::move(topology)), coordinates_(std::move(coordinates)) {
    if (topology_->dimension() != dim)
      throw InputError("a mesh of dimension " + std::to_string(dim) +
                       " cannot have cells of dimension " + std::to_string(topology_->dimension()));
    if (coordinates_.size() != topology_->n_nodes())
      throw InputError("the mesh has " + std::to_string(topology_->n_nodes()) + " nodes but " +
                       std::to_string(coordinates_.size()) + " coordinates");
    for (std::size_t i = 0; i < coordinates_.size(); ++i)
      if (!coordinates_[i].allFinite())
        throw InputError("node " + std::to_string(i) +
                         " has a coordinate that is not a finite number");
  }

  const Topology& topology() const { return *topology_; }
  const std::shared_ptr<const Topology>& shared_topology() const { return topology_; }

  std::size_t n_nodes() const { return coordinates_.size(); }
  std::size_t n_cells() const { return topology_->n_cells(); }

  const std::vector<PointType>& coordinates() const { return coordinates_; }
  std::vector<PointType>& coordinates() { return coordinates_; }

 private:
  std::shared_ptr<const Topology> topology_;
  std::vector<PointType> coordinates_;
};

using PlanarMesh = Mesh<2>;
using VolumeMesh = Mesh<3>;
using AnyMesh = std::variant<PlanarMesh, VolumeMesh>;

/// visit.operator()<dim>() for a dimension that is known only now: 2 or 3.
template <class Visit>
decltype(auto) with_dimension(int dim, const Visit& visit) {
  return dim == 2 ? visit.template operator()<2>() : visit.template operator()<3>();
}

}  // namespace smoothfem
