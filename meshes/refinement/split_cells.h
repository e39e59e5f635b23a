// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// The cells of a split mesh, without the tables of a Topology.
template <int dim>
struct SplitCells {
  std::vector<Point<dim>> points{};   ///< existing nodes, then new ones
  CompressedRows<NodeIndex> means{};  ///< existing nodes that each new node is the mean of
  CompressedRows<NodeIndex> cells{};  ///< parts of one cell follow each other
  std::vector<CellIndex> origins{};   ///< the cell that each of these is a part of
  MeshLabels labels{};                ///< tags, labelled facets, names, plane in space
};

/// Splits cells as with_split_cells() does. numbers: n_nodes() different numbers; sums for means
/// are taken in their ascending order, and `means` has it, too. Empty: the order of the nodes.
template <int dim>
SplitCells<dim> split_cells(const Mesh<dim>& mesh, std::span<const std::uint32_t> numbers = {});

/// Splits every cell: triangles and quadrilaterals into 4, tetrahedra, prisms and hexahedra into 8,
/// pyramids into 6 pyramids and 4 tetrahedra. New nodes are means of the nodes of an edge, a
/// quadrilateral, or a hexahedron, so that sides keep their shape. The inner octahedron of a
/// tetrahedron is cut along its shortest diagonal. Parts inherit cell and facet tags with their
/// names; existing nodes keep their numbers. All cells must be valid; the parts of a hexahedron
/// that is valid at its corners may be invalid. Throws InputError for polygons with more than four
/// nodes.
template <int dim>
Mesh<dim> with_split_cells(const Mesh<dim>& mesh);

/// As above. In addition, existing nodes that stay do so in the refined mesh, too. A new node stays
/// if it lies on the boundary between nodes that stay.
template <int dim>
Mesh<dim> refined(const Mesh<dim>& mesh);

/// Returns what a mesh says that its split mesh does not, for example "the field pressure".
std::vector<std::string> losses_of_splitting(const MeshLabels& labels);

}  // namespace smoothfem
