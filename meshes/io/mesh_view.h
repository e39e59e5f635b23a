#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A mesh of either dimension as writers see it: in space, planar ones with z = 0. Refers to the
/// mesh, which has to outlive it.
class MeshView {
 public:
  MeshView(const PlanarMesh& mesh) : topology_(mesh.topology()), planar_(&mesh) {}
  MeshView(const VolumeMesh& mesh) : topology_(mesh.topology()), volume_(&mesh) {}
  MeshView(const AnyMesh& mesh)
      : MeshView(std::visit([](const auto& m) { return MeshView(m); }, mesh)) {}

  int dimension() const { return topology_.dimension(); }
  const Topology& topology() const { return topology_; }
  std::size_t n_nodes() const { return topology_.n_nodes(); }
  std::size_t n_cells() const { return topology_.n_cells(); }

  Point<3> point(NodeIndex node) const {
    if (volume_) return volume_->coordinates()[node];
    const auto& p = planar_->coordinates()[node];
    return {p.x(), p.y(), 0.0};
  }

  /// The mesh itself; null if it is a volume mesh.
  const PlanarMesh* planar() const { return planar_; }

 private:
  const Topology& topology_;
  const PlanarMesh* planar_ = nullptr;
  const VolumeMesh* volume_ = nullptr;
};

}  // namespace smoothfem
