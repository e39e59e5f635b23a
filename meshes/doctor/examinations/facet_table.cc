// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/doctor/examinations/facet_table.h"

#include <algorithm>
#include <tuple>

#include "smoothing/mesh/volume_elements.h"

namespace smoothfem {

namespace {

/// Calls visit(position, nodes) for the facets of a cell, with the nodes in the cell's direction.
template <class Visit>
void for_each_facet_of(int dim, std::span<const NodeIndex> cell, const Visit& visit) {
  std::uint32_t position = 0;
  for_each_facet(dim, cell.size(), [&](std::span<const std::size_t> at) {
    std::array<NodeIndex, 4> nodes{};
    for (std::size_t k = 0; k < at.size(); ++k) nodes[k] = cell[at[k]];
    visit(position++, std::span<const NodeIndex>(nodes.data(), at.size()));
  });
}

/// Returns the facet without its smallest node.
CellFacet cell_facet(CellIndex cell, std::uint32_t position, std::span<const NodeIndex> nodes) {
  const std::size_t n = nodes.size();
  const auto at =
      static_cast<std::size_t>(std::min_element(nodes.begin(), nodes.end()) - nodes.begin());
  CellFacet facet{{no_node, no_node, no_node}, cell, position, 0};
  for (std::size_t k = 1; k < n; ++k) facet.others[k - 1] = nodes[(at + k) % n];
  const NodeIndex opposite = facet.others[1];
  facet.cycle = n == 2 ? at : facet.others[0] > facet.others[n - 2];
  std::sort(facet.others.begin(), facet.others.end());
  if (n == 4)
    facet.cycle += 2 * static_cast<std::uint32_t>(
                           std::find(facet.others.begin(), facet.others.end(), opposite) -
                           facet.others.begin());
  return facet;
}

void set_nodes(Skin& skin, std::size_t n_nodes) {
  std::vector<bool> on_skin(n_nodes, false);
  for (const NodeIndex node : skin.facets.entries()) on_skin[node] = true;
  for (NodeIndex i = 0; i < n_nodes; ++i)
    if (on_skin[i]) skin.nodes.push_back(i);
}

}  // namespace

FacetTable::FacetTable(const PlainCells& cells) {
  std::vector<RowOffset> lengths(cells.points.size() + 1, 0);
  const auto for_each_cell = [&](const auto& visit) {
    for (CellIndex c = 0; c < cells.cells.size(); ++c)
      for_each_facet_of(cells.dim, cells.cells[c],
                        [&](std::uint32_t position, std::span<const NodeIndex> nodes) {
                          visit(c, position, nodes, *std::min_element(nodes.begin(), nodes.end()));
                        });
  };
  for_each_cell([&](auto, auto, auto, NodeIndex least) { ++lengths[least + 1]; });
  offsets_ = row_offsets(std::move(lengths));
  facets_.resize(offsets_.back());
  auto next = offsets_;
  for_each_cell([&](CellIndex c, std::uint32_t position, std::span<const NodeIndex> nodes,
                    NodeIndex least) { facets_[next[least]++] = cell_facet(c, position, nodes); });
  const auto at = [&](NodeIndex node) {
    return facets_.begin() + static_cast<std::ptrdiff_t>(offsets_[node]);
  };
  for (NodeIndex node = 0; node + 1 < offsets_.size(); ++node)
    std::sort(at(node), at(node + 1), [](const CellFacet& a, const CellFacet& b) {
      return std::tie(a.others, a.cell, a.position) < std::tie(b.others, b.cell, b.position);
    });
}

Skin skin_of(const PlainCells& cells,
             std::vector<std::pair<CellIndex, std::uint32_t>> cells_and_positions) {
  std::sort(cells_and_positions.begin(), cells_and_positions.end());
  Skin skin;
  for (const auto& [cell, wanted] : cells_and_positions) {
    for_each_facet_of(
        cells.dim, cells.cells[cell],
        [&, wanted = wanted](std::uint32_t position, std::span<const NodeIndex> nodes) {
          if (position == wanted) skin.facets.append(nodes);
        });
    skin.cells.push_back(cell);
  }
  set_nodes(skin, cells.points.size());
  return skin;
}

Skin skin_of(const PlainCells& cells, const FacetTable& table) {
  std::vector<std::pair<CellIndex, std::uint32_t>> facets;
  table.for_each([&](NodeIndex, std::span<const CellFacet> group) {
    if (group.size() == 1) facets.emplace_back(group[0].cell, group[0].position);
  });
  return skin_of(cells, std::move(facets));
}

Skin skin_of(const Topology& topology) {
  Skin skin{topology.boundary_facets(), {}, {}};
  for (CellIndex c = 0; c < topology.n_cells(); ++c)
    for_each_facet_of(
        topology.dimension(), topology.cell_nodes(c),
        [&](std::uint32_t, std::span<const NodeIndex> nodes) {
          const std::size_t next = skin.cells.size();
          if (next < skin.facets.size() && std::ranges::equal(nodes, skin.facets[next]))
            skin.cells.push_back(c);
        });
  set_nodes(skin, topology.n_nodes());
  return skin;
}

}  // namespace smoothfem
