// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A mesh of any kind, in the form that writers need: in space, planar ones in the
/// plane of their file, by default z = 0. Refers to
/// the mesh, which must outlive it.
class MeshView {
 public:
  MeshView(const PlanarMesh& mesh) : topology_(mesh.topology()), planar_(&mesh) {}
  MeshView(const VolumeMesh& mesh) : topology_(mesh.topology()), in_space_(mesh.coordinates()) {}
  MeshView(const SurfaceMesh& mesh) : topology_(mesh.topology()), in_space_(mesh.coordinates()) {}
  MeshView(const AnyMesh& mesh)
      : MeshView(std::visit([](const auto& m) { return MeshView(m); }, mesh)) {}

  /// Returns the dimension of the cells: 2 or 3.
  int dimension() const { return topology_.dimension(); }
  const Topology& topology() const { return topology_; }
  std::size_t n_nodes() const { return topology_.n_nodes(); }
  std::size_t n_cells() const { return topology_.n_cells(); }
  bool is_surface() const { return dimension() == 2 && !planar_; }

  Point<3> point(NodeIndex node) const {
    if (!planar_) return in_space_[node];
    const auto& p = planar_->coordinates()[node];
    if (content() && content()->plane) return content()->plane->in_space(node, p);
    return {p.x(), p.y(), 0.0};
  }

  /// Returns what else the mesh's file says; null if nothing.
  const FileContent* content() const { return topology_.labels().content.get(); }

  /// Returns the mesh itself; null if it is not planar.
  const PlanarMesh* planar() const { return planar_; }

 private:
  const Topology& topology_;
  const PlanarMesh* planar_ = nullptr;
  std::span<const Point<3>> in_space_;  ///< coordinates of all but planar meshes
};

}  // namespace smoothfem
