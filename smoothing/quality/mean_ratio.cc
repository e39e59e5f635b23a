#include "smoothing/quality/mean_ratio.h"

#include <array>

namespace smoothfem {

namespace {

template <std::size_t n>
double gathered_mean_ratio(const std::vector<Point<2>>& coordinates, const NodeIndex* nodes) {
  std::array<Point<2>, n> corners;
  for (std::size_t k = 0; k < n; ++k) corners[k] = coordinates[nodes[k]];
  return mean_ratio(corners);
}

}  // namespace

double cell_mean_ratio(const PlanarMesh& mesh, CellIndex cell) {
  const auto nodes = mesh.topology().cell_nodes(cell);
  const auto& coordinates = mesh.coordinates();
  switch (nodes.size()) {
    case 3:
      return gathered_mean_ratio<3>(coordinates, nodes.data());
    case 4:
      return gathered_mean_ratio<4>(coordinates, nodes.data());
    default: {
      std::vector<Point<2>> corners;
      for (const NodeIndex node : nodes) corners.push_back(coordinates[node]);
      return mean_ratio(corners);
    }
  }
}

}  // namespace smoothfem
