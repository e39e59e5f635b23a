// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/loop/invalid_node_reset.h"

#include "smoothing/mesh/node_constraints.h"
#include "smoothing/parts/shared_coordinates.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/second_order/curved_quality.h"

namespace smoothfem {

namespace {

/// Returns the facets beyond the bound of the mesh: all, or those around some nodes.
template <int dim, int spacedim, class... Around>
std::vector<std::uint32_t> facets_out_of_bound(const Mesh<dim, spacedim>& mesh,
                                               const Around&... around) {
  if (has_facet_bound(mesh))
    return mesh.constraints()->facets_out_of_bound(mesh.coordinates(), around...);
  return {};
}

/// Resets those nodes of these cells and facets that are not reset yet.
template <int dim, int spacedim>
std::vector<NodeIndex> reset_nodes(Mesh<dim, spacedim>& mesh,
                                   std::type_identity_t<std::span<const Point<spacedim>>> previous,
                                   const std::vector<CellIndex>& cells,
                                   const std::vector<std::uint32_t>& facets) {
  std::vector<NodeIndex> moved;
  const auto reset = [&](std::span<const NodeIndex> nodes) {
    for (const NodeIndex i : nodes)
      if (mesh.coordinates()[i] != previous[i]) {
        mesh.coordinates()[i] = previous[i];
        moved.push_back(i);
      }
  };
  for (const CellIndex c : cells) {
    reset(mesh.topology().cell_nodes(c));
    reset(mesh.topology().midside_nodes(c));
  }
  for (const std::uint32_t f : facets) reset(mesh.constraints()->facet_nodes(f));
  return moved;
}

/// Returns the cells with nodes that reset_nodes() has moved. cells: those it got. A midside node
/// belongs to cells that share corners.
template <int dim, int spacedim>
std::vector<CellIndex> cells_to_check(const Mesh<dim, spacedim>& mesh,
                                      const std::vector<CellIndex>& cells,
                                      const std::vector<NodeIndex>& moved) {
  if (!mesh.topology().midside()) return mesh.topology().cells_around(moved);
  std::vector<NodeIndex> corners = moved;
  for (const CellIndex c : cells)
    for (const NodeIndex i : mesh.topology().cell_nodes(c)) corners.push_back(i);
  return mesh.topology().cells_around(corners);
}

/// Returns the quality of a linear or curved cell.
template <int dim, int spacedim>
double quality_of(const Mesh<dim, spacedim>& mesh, CellIndex cell) {
  if constexpr (dim == spacedim)
    if (!mesh.topology().midside_nodes(cell).empty()) return curved_mean_ratio(mesh, cell);
  return cell_mean_ratio(mesh, cell);
}

}  // namespace

template <int dim, int spacedim>
std::vector<NodeIndex> reset_nodes_of_invalid_cells(
    Mesh<dim, spacedim>& mesh, std::type_identity_t<std::span<const Point<spacedim>>> previous,
    std::vector<double>& cell_quality, double min_quality) {
  const auto is_bad = [&](double q) { return !(q > 0.0) || q < min_quality; };
  std::vector<CellIndex> bad;
  for (CellIndex c = 0; c < cell_quality.size(); ++c)
    if (is_bad(cell_quality[c])) bad.push_back(c);
  std::vector<std::uint32_t> facets = facets_out_of_bound(mesh);
  std::vector<NodeIndex> all_moved;
  while (true) {
    auto moved = reset_nodes(mesh, previous, bad, facets);
    const auto elsewhere = changed_copies(mesh);
    moved.insert(moved.end(), elsewhere.begin(), elsewhere.end());
    if (!holds_anywhere(mesh.topology(), !moved.empty()))
      return all_moved;  // the remaining cells were invalid before
    all_moved.insert(all_moved.end(), moved.begin(), moved.end());
    const auto changed = cells_to_check(mesh, bad, moved);
    bad.clear();
    for (const CellIndex c : changed) {
      cell_quality[c] = quality_of(mesh, c);
      if (is_bad(cell_quality[c])) bad.push_back(c);
    }
    facets = facets_out_of_bound(mesh, moved);
  }
}

template std::vector<NodeIndex> reset_nodes_of_invalid_cells(Mesh<2>&, std::span<const Point<2>>,
                                                             std::vector<double>&, double);
template std::vector<NodeIndex> reset_nodes_of_invalid_cells(Mesh<3>&, std::span<const Point<3>>,
                                                             std::vector<double>&, double);
template std::vector<NodeIndex> reset_nodes_of_invalid_cells(Mesh<2, 3>&, std::span<const Point<3>>,
                                                             std::vector<double>&, double);

}  // namespace smoothfem
