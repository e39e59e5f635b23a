// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "smoothing/simd/cells.h"

namespace smoothfem {

/// The nodes of the cells around each free node, in the order in which a sweep over the free nodes
/// reads them. The topology has them in two tables; a sweep reads the second one in scattered
/// order. With those tables the weighted Laplacian took three times as long in a mesh generator's
/// order, and 1.5 times as long in a good order.
class CellsAroundNodes {
 public:
  /// Larger meshes (of 16 million tetrahedra) use the topology's tables and no additional memory.
  static constexpr std::size_t default_max_entries = std::size_t{1} << 28;

  explicit CellsAroundNodes(std::size_t max_entries = default_max_entries)
      : max_entries_(max_entries) {}

  /// Builds the table, unless it belongs to this topology already.
  void prepare(std::shared_ptr<const Topology> topology);

  /// Calls use(cells) with the cells around a free node, in the form that for_each_batch takes.
  /// position: the node's among the free ones. Returns the result of `use`.
  template <class Use>
  auto with_cells(std::size_t position, const Use& use) const {
    const ListedCells cells(*topology_, topology_->node_cells(topology_->free_nodes()[position]));
    return rows_.empty() ? use(cells) : use(TabledCells{cells, &rows_, first_rows_[position]});
  }

 private:
  /// Cells whose nodes are consecutive rows of the table.
  struct TabledCells {
    ListedCells cells;
    const CompressedRows<NodeIndex>* rows;
    std::size_t first_row;

    std::size_t size() const { return cells.size(); }
    CellIndex number(std::size_t position) const { return cells.number(position); }
    std::span<const NodeIndex> nodes(std::size_t position) const {
      return (*rows)[first_row + position];
    }
  };

  std::size_t max_entries_;
  std::shared_ptr<const Topology> topology_;
  std::vector<RowOffset> first_rows_;  ///< first row of each free node
  CompressedRows<NodeIndex> rows_;     ///< empty: the topology's tables are used
};

}  // namespace smoothfem
