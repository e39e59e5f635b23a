#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "smoothing/mesh/compressed_rows.h"
#include "smoothing/mesh/element_type.h"

namespace smoothfem {

using NodeIndex = std::uint32_t;
using CellIndex = std::uint32_t;

/// What a file says about cells besides their nodes; carried from input to output unchanged.
struct MeshLabels {
  std::vector<int> cell_tags;        ///< physical tag of each cell; empty if the file has none
  CompressedRows<NodeIndex> facets;  ///< labelled boundary entities (edges of planar meshes)
  std::vector<int> facet_tags;       ///< physical tag of each facet
  std::map<std::pair<int, int>, std::string> names;  ///< (dimension, tag) -> physical name

  bool operator==(const MeshLabels&) const = default;
};

/// The connectivity of a planar mesh: which nodes make which cell, and everything that follows
/// from it alone. Immutable. All adjacency rows are sorted ascending, so sums over them have one
/// order.
class Topology {
 public:
  /// cells: one row of node indices a cell, counterclockwise, at least three, all different and
  /// below n_nodes. fixed: n_nodes flags of nodes that smoothing must not move; without it the
  /// boundary nodes are fixed. Nodes that no cell uses are always fixed. Throws InputError naming
  /// the first cell that breaks this, or an edge with more than two cells.
  Topology(std::size_t n_nodes, CompressedRows<NodeIndex> cells,
           std::optional<std::vector<bool>> fixed = std::nullopt, MeshLabels labels = {});

  std::size_t n_nodes() const { return node_cells_.size(); }
  std::size_t n_cells() const { return cells_.size(); }

  const CompressedRows<NodeIndex>& cells() const { return cells_; }
  std::span<const NodeIndex> cell_nodes(CellIndex cell) const { return cells_[cell]; }
  ElementType cell_type(CellIndex cell) const { return planar_element_type(cells_[cell].size()); }

  /// Cells that use a node.
  std::span<const CellIndex> node_cells(NodeIndex node) const { return node_cells_[node]; }
  /// Nodes joined to a node by an edge.
  std::span<const NodeIndex> node_neighbours(NodeIndex node) const {
    return node_neighbours_[node];
  }

  /// Edges with one cell, as (from, to) in that cell's direction, ordered by cell and position in
  /// it.
  const std::vector<std::pair<NodeIndex, NodeIndex>>& boundary_edges() const {
    return boundary_edges_;
  }
  std::size_t n_edges() const { return n_edges_; }
  /// True for nodes of boundary edges.
  const std::vector<bool>& on_boundary() const { return on_boundary_; }

  bool is_fixed(NodeIndex node) const { return fixed_[node] != 0; }
  const std::vector<NodeIndex>& free_nodes() const { return free_nodes_; }
  /// True if at least one node of the cell is free: the cells that q*_min looks at.
  bool has_free_node(CellIndex cell) const { return cell_has_free_node_[cell] != 0; }

  const MeshLabels& labels() const { return labels_; }

 private:
  void check_cells(std::size_t n_nodes) const;
  void build_node_cells(std::size_t n_nodes);
  void build_edges(std::size_t n_nodes);
  void build_fixed(const std::optional<std::vector<bool>>& fixed);

  CompressedRows<NodeIndex> cells_;
  MeshLabels labels_;
  CompressedRows<CellIndex> node_cells_;
  CompressedRows<NodeIndex> node_neighbours_;
  std::vector<std::pair<NodeIndex, NodeIndex>> boundary_edges_;
  std::size_t n_edges_ = 0;
  std::vector<bool> on_boundary_;
  std::vector<std::uint8_t> fixed_;
  std::vector<NodeIndex> free_nodes_;
  std::vector<std::uint8_t> cell_has_free_node_;
};

}  // namespace smoothfem
