// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "smoothing/mesh/compressed_rows.h"
#include "smoothing/mesh/element_type.h"
#include "smoothing/mesh/fixed_reason.h"
#include "smoothing/mesh/mesh_labels.h"
#include "smoothing/mesh/point.h"
#include "smoothing/mesh/table_on_demand.h"

namespace smoothfem {

/// Consecutive cells and the nodes they use; parallel loops over cells take one block at a time.
/// The number of blocks depends on the mesh alone, never on the number of threads.
struct CellBlock {
  CellIndex first, last;            ///< cells first .. last - 1
  NodeIndex first_node, last_node;  ///< all their nodes are in first_node .. last_node - 1
};

/// The connectivity of a planar or volume mesh: the nodes of each cell, and all tables that follow
/// from them. Cells of second order have midside nodes in addition; all other tables are those of
/// the corners. Immutable. All adjacency rows are sorted ascending, which fixes the order of sums
/// over them.
class Topology {
 public:
  /// dim: 2 (cells with three or more nodes, counterclockwise) or 3 (4, 5, 6 or 8 nodes in the
  /// order of volume_elements.h). cells: one row of node indices for each cell, all different and
  /// below n_nodes; no two cells have the same nodes. fixed: n_nodes flags of nodes that smoothing
  /// must not move (reason: marked); default: the boundary nodes. Nodes that no cell uses are
  /// always fixed, and so are midside nodes. Throws InputError that names the first cell that
  /// breaks these rules, or a facet with more than two cells.
  Topology(int dim, std::size_t n_nodes, CompressedRows<NodeIndex> cells,
           std::optional<std::vector<bool>> fixed = std::nullopt, MeshLabels labels = {});
  /// As above. reasons: for each node why it stays, 0 if it may move.
  Topology(int dim, std::size_t n_nodes, CompressedRows<NodeIndex> cells,
           std::vector<FixedReasons> reasons, MeshLabels labels);

  /// As above. make_reasons(topology): returns these reasons, from a topology that knows its cells
  /// and its boundary.
  Topology(int dim, std::size_t n_nodes, CompressedRows<NodeIndex> cells, MeshLabels labels,
           const std::function<std::vector<FixedReasons>(const Topology&)>& make_reasons);

  int dimension() const { return dim_; }
  std::size_t n_nodes() const { return fixed_.size(); }
  std::size_t n_cells() const { return cells_.size(); }

  const CompressedRows<NodeIndex>& cells() const { return cells_; }
  std::span<const NodeIndex> cell_nodes(CellIndex cell) const { return cells_[cell]; }
  ElementType cell_type(CellIndex cell) const { return element_type(dim_, cells_[cell].size()); }
  const std::vector<CellBlock>& blocks() const { return blocks_; }

  /// Returns the midside nodes of elements of second order; null if all elements are linear.
  const MidsideNodes* midside() const { return labels_.midside.get(); }
  /// Returns the midside nodes of a cell in the order of midside_nodes.h; empty if it is linear.
  std::span<const NodeIndex> midside_nodes(CellIndex cell) const {
    return midside() ? midside()->of_cells[cell] : std::span<const NodeIndex>();
  }

  /// Returns what this part of a distributed mesh shares with others; null for a whole mesh.
  const MeshPart* part() const { return labels_.part.get(); }

  /// Returns the cells that use a node.
  std::span<const CellIndex> node_cells(NodeIndex node) const { return cells_by_node()[node]; }
  /// Returns the cells that use at least one of these nodes, ascending.
  std::vector<CellIndex> cells_around(std::span<const NodeIndex> nodes) const;
  /// Returns the nodes joined to a node by an edge.
  std::span<const NodeIndex> node_neighbours(NodeIndex node) const { return neighbours()[node]; }
  std::size_t n_edges() const { return neighbours().n_entries() / 2; }
  /// Builds the table of node_cells() now instead of at its first use.
  void build_node_cells() const { cells_by_node(); }
  /// Builds the table of node_neighbours(), and the one of node_cells(), now instead of at first
  /// use.
  void build_node_neighbours() const { neighbours(); }

  /// Returns the facets (sides of planar cells, faces of volume cells) that belong to one cell
  /// only. Each has that cell's nodes in its direction. They are ordered by cell and position in
  /// it.
  const CompressedRows<NodeIndex>& boundary_facets() const { return boundary_facets_; }
  /// Returns the number of facets, inner and boundary ones.
  std::size_t n_facets() const { return n_facets_; }
  /// Returns flags of the nodes of boundary facets.
  const std::vector<bool>& on_boundary() const { return on_boundary_; }

  bool is_fixed(NodeIndex node) const { return fixed_[node] != 0; }
  /// Returns why a node stays; 0 if it may move.
  FixedReasons fixed_reasons(NodeIndex node) const { return fixed_[node]; }
  const std::vector<FixedReasons>& fixed_reasons() const { return fixed_; }
  /// Returns the same, but 0 for midside nodes, which do not stay but follow their corners.
  FixedReasons reasons_to_stay(NodeIndex node) const {
    return static_cast<FixedReasons>(fixed_[node] & ~bit(FixedReason::midside));
  }
  /// Returns the nodes that may move, ascending; in a part of a mesh, of these its own.
  const std::vector<NodeIndex>& free_nodes() const { return free_nodes_; }
  /// True if at least one node of the cell is free. q*_min takes these cells only.
  bool has_free_node(CellIndex cell) const { return cell_has_free_node_[cell] != 0; }

  const MeshLabels& labels() const { return labels_; }

  /// Returns the same mesh without midside nodes: these are then nodes that no cell uses.
  std::shared_ptr<const Topology> without_midside() const;

  /// Returns the same mesh in another order, without labels. Node i and cell c of the result are
  /// node node_order[i] and cell cell_order[c] of this one. Cells keep the order of their nodes.
  /// node_order may leave out nodes that no cell uses.
  std::shared_ptr<const Topology> reordered(const std::vector<NodeIndex>& node_order,
                                            const std::vector<CellIndex>& cell_order) const;

 private:
  Topology() = default;
  void check_cells(std::size_t n_nodes) const;
  const CompressedRows<CellIndex>& cells_by_node() const {
    return node_cells_.get([this] { return rows_by_entry(cells_, n_nodes()); });
  }
  const CompressedRows<NodeIndex>& neighbours() const;
  void build_boundary(const CompressedRows<CellIndex>& node_cells);
  template <class Reasons>
  void build(std::size_t n_nodes, const Reasons& make_reasons);
  void build_fixed(std::vector<FixedReasons> reasons);
  void build_blocks();

  int dim_ = 2;
  CompressedRows<NodeIndex> cells_;
  MeshLabels labels_;
  mutable TableOnDemand node_cells_, node_neighbours_;
  CompressedRows<NodeIndex> boundary_facets_;
  std::size_t n_facets_ = 0;
  std::vector<bool> on_boundary_;
  std::vector<FixedReasons> fixed_;
  std::vector<NodeIndex> free_nodes_;
  std::vector<std::uint8_t> cell_has_free_node_;
  std::vector<CellBlock> blocks_;
};

/// Throws InputError if a mesh has cells of second order. what: for example "distortion".
void require_linear(const Topology& topology, const std::string& what);

/// Returns for each node the nodes joined to it by an edge, ascending. node_cells: the cells of
/// each node.
CompressedRows<NodeIndex> nodes_by_node(const Topology& topology,
                                        const CompressedRows<CellIndex>& node_cells);

}  // namespace smoothfem
