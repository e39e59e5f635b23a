// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/tests/planar_meshes.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem::test {

/// Makes the sides of a box of this width periodic in some directions. Node positions must be those
/// of a grid.
template <int dim>
Mesh<dim> with_periodic_sides(const Mesh<dim>& mesh, double width,
                              const std::vector<int>& directions) {
  auto content = std::make_shared<FileContent>();
  for (const int d : directions) {
    PeriodicEntity entity{
        .dimension = dim - 1, .entity = 2 * d + 2, .partner = 2 * d + 1, .affine = {}, .nodes = {}};
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      for (NodeIndex j = 0; j < mesh.n_nodes(); ++j)
        if ((mesh.coordinates()[i] - mesh.coordinates()[j] - width * Point<dim>::Unit(d)).norm() <
            1e-12)
          entity.nodes.push_back({i, j});
    content->periodic.push_back(std::move(entity));
  }
  MeshLabels labels;
  labels.content = std::move(content);
  const Topology topology(dim, mesh.n_nodes(), mesh.topology().cells(), std::nullopt, labels);
  auto reasons = topology.fixed_reasons();
  add_implied_reasons(topology, reasons);
  return {std::make_shared<const Topology>(dim, mesh.n_nodes(), topology.cells(),
                                           std::move(reasons), std::move(labels)),
          mesh.copied_coordinates()};
}

}  // namespace smoothfem::test
