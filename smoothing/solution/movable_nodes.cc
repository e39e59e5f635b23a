// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/solution/movable_nodes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "smoothing/mesh/boundary_tags.h"

namespace smoothfem {

namespace {

/// Returns the normal of a side, or those at each corner of a face, whose four nodes need not be in
/// one plane.
std::vector<Point<2>> normals(std::span<const NodeIndex> side, std::span<const Point<2>> x) {
  const Point<2> along = x[side[1]] - x[side[0]];
  return {Point<2>(along.y(), -along.x()).normalized()};
}
std::vector<Point<3>> normals(std::span<const NodeIndex> face, std::span<const Point<3>> x) {
  std::vector<Point<3>> all;
  for (std::size_t k = 0, n = face.size(); k < n; ++k) {
    const Point<3>& here = x[face[k]];
    const Point<3> next = x[face[(k + 1) % n]] - here, last = x[face[(k + n - 1) % n]] - here;
    all.push_back(next.cross(last).normalized());
  }
  return all;
}

/// Directions that the facets around a boundary node allow.
template <int dim>
struct Surroundings {
  CellTensor<dim> of_normals = CellTensor<dim>::Zero();  ///< sum of n n^T
  int n_normals = 0;
  int tag = 0;
  bool has_two_tags = false;

  void add(const Point<dim>& normal, int facet_tag) {
    has_two_tags = has_two_tags || (n_normals > 0 && facet_tag != tag);
    tag = facet_tag;
    of_normals += normal * normal.transpose();
    ++n_normals;
  }

  /// Returns the projection onto the directions at right angles to all normals; zero if there are
  /// none.
  CellTensor<dim> projection() const {
    constexpr double tolerance = 1e-9;  // for squares: normals differ by the rounding of nodes
    if (has_two_tags || n_normals == 0) return CellTensor<dim>::Zero();
    const Eigen::SelfAdjointEigenSolver<CellTensor<dim>> eigen(of_normals / n_normals);
    CellTensor<dim> sum = CellTensor<dim>::Zero();
    for (int d = 0; d < dim; ++d) {
      const Point<dim> direction = eigen.eigenvectors().col(d);
      if (eigen.eigenvalues()[d] < tolerance) sum += direction * direction.transpose();
    }
    return sum;
  }
};

}  // namespace

template <int dim>
MovableNodes<dim>::MovableNodes(const Mesh<dim>& mesh, bool boundary_slides)
    : contains_(mesh.n_nodes(), stays) {
  const Topology& topology = mesh.topology();
  for (const NodeIndex i : topology.free_nodes()) contains_[i] = moves;
  if (boundary_slides) {
    projections_.assign(mesh.n_nodes(), CellTensor<dim>::Zero());
    std::vector<Surroundings<dim>> around(mesh.n_nodes());
    const auto& facets = topology.boundary_facets();
    const auto tags = boundary_tags(topology);
    for (std::size_t f = 0; f < facets.size(); ++f)
      for (const Point<dim>& normal : normals(facets[f], mesh.coordinates()))
        for (const NodeIndex i : facets[f]) around[i].add(normal, tags.empty() ? 0 : tags[f]);
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      if (topology.on_boundary()[i]) {
        projections_[i] = around[i].projection();
        contains_[i] = projections_[i].trace() > 0.5 ? slides : stays;
      }
  }
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    if (contains(i)) nodes_.push_back(i);
}

template class MovableNodes<2>;
template class MovableNodes<3>;

}  // namespace smoothfem
