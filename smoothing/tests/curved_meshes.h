// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/quality/mesh_quality.h"
#include "smoothing/second_order/raise_order.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem::test {

/// The square [0, 2]^2 of four triangles TRI6 around a node at `middle`; the midside node of the
/// lower side lies at (1, sag).
inline PlanarMesh four_triangles(const Point<2>& middle, double sag) {
  CompressedRows<NodeIndex> cells;
  for (NodeIndex k = 0; k < 4; ++k) cells.append(std::array<NodeIndex, 3>{k, (k + 1) % 4, 4});
  const std::vector<Point<2>> points{{0, 0}, {2, 0}, {2, 2}, {0, 2}, middle};
  PlanarMesh mesh =
      with_midside_nodes(PlanarMesh(std::make_shared<const Topology>(2, 5, cells), points));
  mesh.coordinates()[mesh.topology().midside_nodes(0)[0]] = {1.0, sag};
  return mesh;
}

template <int dim>
NamedMeshes<dim> small_meshes() {
  if constexpr (dim == 2)
    return {{"triangles", grid_mesh(4, GridCells::triangles)},
            {"quadrilaterals", grid_mesh(4, GridCells::quadrilaterals)},
            {"mixed", grid_mesh(4, GridCells::mixed)}};
  else
    return {{"tetrahedra", box_mesh(2, 2, 2, BoxCells::tetrahedra)},
            {"pyramids", box_mesh(2, 1, 1, BoxCells::pyramids)},
            {"prisms", box_mesh(2, 2, 2, BoxCells::prisms)},
            {"hexahedra", box_mesh(2, 2, 2, BoxCells::hexahedra)}};
}

/// A valid mesh whose corners and midside nodes, also those of the boundary, are moved at random.
template <int dim>
Mesh<dim> random_curved_mesh(const Mesh<dim>& linear, SecondOrderKind kind, std::uint64_t seed) {
  Mesh<dim> corners = linear;
  distort(corners, 0.2, seed);
  const Mesh<dim> straight = with_midside_nodes(corners, kind);
  for (double radius = 0.12;; radius *= 0.7) {
    Mesh<dim> mesh = straight;
    Random random(seed);
    std::vector<bool> is_midside(mesh.n_nodes(), true);
    for (NodeIndex i = 0; i < linear.n_nodes(); ++i) is_midside[i] = false;
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      for (int d = 0; is_midside[i] && d < dim; ++d) mesh.coordinates()[i][d] += radius * random();
    if (mesh_quality(mesh).n_invalid == 0) return mesh;
  }
}

}  // namespace smoothfem::test
