#include "smoothing/loop/invalid_node_reset.h"

#include <algorithm>

#include "smoothing/quality/mean_ratio.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {

namespace {

/// Moves back the nodes of the invalid cells that are not back yet.
template <int dim, int spacedim>
std::vector<NodeIndex> put_back(Mesh<dim, spacedim>& mesh,
                                const std::vector<Point<spacedim>>& previous,
                                const std::vector<CellIndex>& invalid) {
  std::vector<NodeIndex> moved;
  for (const CellIndex c : invalid)
    for (const NodeIndex i : mesh.topology().cell_nodes(c))
      if (mesh.coordinates()[i] != previous[i]) {
        mesh.coordinates()[i] = previous[i];
        moved.push_back(i);
      }
  return moved;
}

}  // namespace

template <int dim, int spacedim>
std::vector<NodeIndex> reset_nodes_of_invalid_cells(Mesh<dim, spacedim>& mesh,
                                                    const std::vector<Point<spacedim>>& previous,
                                                    std::vector<double>& cell_quality) {
  std::vector<CellIndex> invalid = invalid_cells(cell_quality);
  std::vector<NodeIndex> all_moved;
  while (!invalid.empty()) {
    const auto moved = put_back(mesh, previous, invalid);
    if (moved.empty()) break;  // the cells were invalid before
    all_moved.insert(all_moved.end(), moved.begin(), moved.end());
    invalid.clear();
    for (const CellIndex c : mesh.topology().cells_around(moved)) {
      cell_quality[c] = cell_mean_ratio(mesh, c);
      if (!(cell_quality[c] > 0.0)) invalid.push_back(c);
    }
  }
  return all_moved;
}

template std::vector<NodeIndex> reset_nodes_of_invalid_cells(Mesh<2>&, const std::vector<Point<2>>&,
                                                             std::vector<double>&);
template std::vector<NodeIndex> reset_nodes_of_invalid_cells(Mesh<3>&, const std::vector<Point<3>>&,
                                                             std::vector<double>&);
template std::vector<NodeIndex> reset_nodes_of_invalid_cells(Mesh<2, 3>&,
                                                             const std::vector<Point<3>>&,
                                                             std::vector<double>&);

}  // namespace smoothfem
