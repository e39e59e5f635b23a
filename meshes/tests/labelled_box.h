// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {

/// A box with all kinds of labels, and coordinates that need all digits.
inline VolumeMesh labelled_box(test::BoxCells kind) {
  VolumeMesh mesh = test::box_mesh(2, 2, 4, kind);
  for (auto& point : mesh.coordinates())
    point = Point<3>(point.x() / 3.0 + 1e-17, point.y() / 7.0, point.z() * 1.1 - 1e-300);
  const Topology& topology = mesh.topology();
  MeshLabels labels;
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    labels.cell_tags.push_back(c % 3 == 0 ? 12 : 4);
    labels.cell_ids.push_back(10 * c + 7);
  }
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i) labels.node_ids.push_back(3 * i + 2);
  const auto& boundary = topology.boundary_facets();
  for (const int tag : {5, 2})
    for (std::size_t f = 0; f < boundary.size(); f += static_cast<std::size_t>(tag)) {
      labels.facets.append(boundary[f]);
      labels.facet_tags.push_back(tag);
    }
  labels.names = {{{3, 12}, "steel"}, {{3, 4}, "air gap"}, {{2, 5}, "inlet"}, {{2, 2}, "wall"}};
  std::vector<bool> fixed = topology.on_boundary();
  fixed[topology.free_nodes().front()] = true;
  return {std::make_shared<const Topology>(3, mesh.n_nodes(), topology.cells(), fixed, labels),
          {mesh.coordinates().begin(), mesh.coordinates().end()}};
}

}  // namespace smoothfem
