// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/getme/regularize.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem::test {

/// Returns the positions of a cell's nodes after the element step of GETMe.
inline std::vector<Point<2>> transformed(const ElementRegularization<2>& element,
                                         const PlanarMesh& mesh, CellIndex cell) {
  std::vector<Vector2<double>> corners;
  for (const NodeIndex node : mesh.topology().cell_nodes(cell))
    corners.push_back(vector_of(mesh.coordinates()[node]));
  std::vector<Vector2<double>> result(corners.size());
  element.regularize(std::span<const Vector2<double>>(corners), std::span<Vector2<double>>(result));
  std::vector<Point<2>> positions;
  for (const auto& corner : result) positions.push_back(point_of(corner));
  return positions;
}

}  // namespace smoothfem::test
