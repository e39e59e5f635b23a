// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/mesh_cells.h"

#include <memory>

#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {

template <int dim>
Mesh<dim> mesh_of(MeshCells<dim> cells, const std::string& name) {
  auto topology =
      std::make_shared<const Topology>(dim, cells.coordinates.size(), std::move(cells.cells));
  Mesh<dim> mesh(std::move(topology), std::move(cells.coordinates));
  require_valid(mesh, name);
  return mesh;
}
template PlanarMesh mesh_of(PlanarCells, const std::string&);
template VolumeMesh mesh_of(VolumeCells, const std::string&);

void require_edge_scale(const std::string& domain, double edge_scale, int most) {
  if (!(edge_scale >= 1.0 && edge_scale <= most))
    throw InputError("the " + domain + "'s edge scale must " +
                     (most > 1 ? "lie between 1 and " + std::to_string(most)
                               : std::string("be 1, as it has one size only")) +
                     ", not " + std::to_string(edge_scale));
}

}  // namespace smoothfem
