#pragma once

#include <memory>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

enum class Cells { triangles, quadrilaterals, mixed };

/// n x n squares on [0, 1]^2, each one quadrilateral or two triangles (mixed: every other square).
/// Inner nodes are moved by `amount` edge lengths in directions that vary from node to node.
inline PlanarMesh unit_square(std::size_t n, Cells kind, double amount) {
  std::vector<Point<2>> points;
  const double h = 1.0 / static_cast<double>(n);
  for (std::size_t j = 0; j <= n; ++j)
    for (std::size_t i = 0; i <= n; ++i) {
      const double x = static_cast<double>(i), y = static_cast<double>(j);
      const bool inner = i > 0 && j > 0 && i < n && j < n;
      const double move = inner ? amount : 0.0;
      points.emplace_back(h * (x + move * std::sin(3.0 * x + 5.0 * y)),
                          h * (y + move * std::cos(4.0 * x - 2.0 * y)));
    }
  CompressedRows<NodeIndex> cells;
  for (NodeIndex j = 0; j < n; ++j)
    for (NodeIndex i = 0; i < n; ++i) {
      const auto width = static_cast<NodeIndex>(n) + 1;
      const NodeIndex a = j * width + i, b = a + 1, c = b + width, d = a + width;
      if (kind == Cells::quadrilaterals || (kind == Cells::mixed && (i + j) % 2 == 0)) {
        cells.append(std::vector{a, b, c, d});
      } else {
        cells.append(std::vector{a, b, c});
        cells.append(std::vector{a, c, d});
      }
    }
  const std::size_t n_nodes = points.size();
  return {std::make_shared<Topology>(2, n_nodes, std::move(cells)), std::move(points)};
}

}  // namespace smoothfem
