// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/mesh/mesh.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem::test {

/// A mesh of two materials with an interface, and distorted cells.
template <int dim>
Mesh<dim> two_materials(const Mesh<dim>& mesh, double distortion, std::uint64_t seed) {
  MeshLabels labels;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    labels.cell_tags.push_back(mesh.coordinates()[mesh.topology().cell_nodes(c)[0]][0] < 2.5 ? 1
                                                                                             : 2);
  auto reasons = mesh.topology().fixed_reasons();
  const Topology tagged(dim, mesh.n_nodes(), mesh.topology().cells(), reasons, labels);
  add_implied_reasons(tagged, reasons);
  Mesh<dim> result(std::make_shared<const Topology>(dim, mesh.n_nodes(), mesh.topology().cells(),
                                                    reasons, labels),
                   mesh.copied_coordinates());
  distort(result, distortion, seed);
  return result;
}

/// Two materials between labelled facets, with numbers of nodes and cells in no order and with
/// gaps, and a node that no cell has.
inline VolumeMesh numbered_mesh() {
  const auto mesh = two_materials(box_mesh(4, 3, 5, BoxCells::mixed), 0.3, 4);
  MeshLabels labels = mesh.topology().labels();
  for (std::size_t f = 0; f < 3; ++f) {
    labels.facets.append(mesh.topology().boundary_facets()[f]);
    labels.facet_tags.push_back(7);
  }
  auto points = mesh.copied_coordinates();
  points.insert(points.begin() + 5, Point<3>(9.0, 9.0, 9.0));
  const auto shifted = [](const CompressedRows<NodeIndex>& rows) {
    CompressedRows<NodeIndex> result;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      std::vector<NodeIndex> row;
      for (const NodeIndex node : rows[r]) row.push_back(node < 5 ? node : node + 1);
      result.append(row);
    }
    return result;
  };
  labels.facets = shifted(labels.facets);
  for (std::size_t i = 0; i < points.size(); ++i) labels.node_ids.push_back(3 + 2 * i + i % 2 * 5);
  for (std::size_t c = 0; c < mesh.n_cells(); ++c)
    labels.cell_ids.push_back(2 * ((c * 7) % mesh.n_cells()) + 10);
  return {std::make_shared<const Topology>(3, points.size(), shifted(mesh.topology().cells()),
                                           std::nullopt, std::move(labels)),
          std::move(points)};
}

}  // namespace smoothfem::test
