// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "meshes/io/mesh_assembly.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Cells before or after a mesh is made of them. Refers to tables of others. Each cell of a mesh of
/// dimension dim (2 or 3) has a possible number of nodes, all different and below points.size().
struct PlainCells {
  int dim;
  const CompressedRows<NodeIndex>& cells;
  std::span<const Point<3>> points;
  bool planar;  ///< cells of dimension 2 lie in a plane z = const
};

/// Returns visit(cells) with those of a mesh, whose nodes are given in space.
template <int dim, int spacedim, class Visit>
auto with_plain_cells(const Mesh<dim, spacedim>& mesh, const Visit& visit) {
  const auto& cells = mesh.topology().cells();
  if constexpr (spacedim == 3) return visit(PlainCells{dim, cells, mesh.coordinates(), false});
  std::vector<Point<3>> points(mesh.n_nodes(), Point<3>::Zero());
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].template head<spacedim>() = mesh.coordinates()[i];
  return visit(PlainCells{dim, cells, points, true});
}

/// A facet (side of a cell of dimension 2, face of a volume cell) as one of its cells has it.
struct CellFacet {
  /// Its nodes without the smallest one, ascending; the rest is no_node.
  std::array<NodeIndex, 3> others;
  CellIndex cell;
  std::uint32_t position;  ///< in the order of for_each_facet
  std::uint32_t cycle;     ///< cyclic order of the nodes

  bool same_nodes(const CellFacet& other) const { return others == other.others; }
  /// True if two cells go around the facet in opposite directions, as cells on both sides do.
  bool is_opposite(const CellFacet& other) const { return (cycle ^ other.cycle) == 1; }
  bool same_direction(const CellFacet& other) const { return cycle == other.cycle; }
};

/// All facets of all cells, by their smallest node.
class FacetTable {
 public:
  explicit FacetTable(const PlainCells& cells);

  /// Calls visit(smallest node, cell facets) for each facet, with all cells that have it.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (NodeIndex node = 0; node + 1 < offsets_.size(); ++node)
      for (RowOffset first = offsets_[node], last = first; first < offsets_[node + 1];
           first = last) {
        while (last < offsets_[node + 1] && facets_[last].same_nodes(facets_[first])) ++last;
        visit(node, std::span(facets_).subspan(first, last - first));
      }
  }

 private:
  std::vector<RowOffset> offsets_;
  std::vector<CellFacet> facets_;
};

/// Facets that belong to one cell only.
struct Skin {
  CompressedRows<NodeIndex> facets;  ///< ordered by cell and position, in the cell's direction
  std::vector<CellIndex> cells;      ///< cell of each facet
  std::vector<NodeIndex> nodes;      ///< all their nodes, ascending
};
Skin skin_of(const PlainCells& cells, const FacetTable& table);
Skin skin_of(const Topology& topology);
/// As above, of facets that are known: cell and position of each, in any order.
Skin skin_of(const PlainCells& cells,
             std::vector<std::pair<CellIndex, std::uint32_t>> cells_and_positions);

}  // namespace smoothfem
