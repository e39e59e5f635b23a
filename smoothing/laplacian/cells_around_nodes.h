// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "smoothing/simd/cells.h"

namespace smoothfem {

/// The nodes of the cells around each free node, in the order in which a sweep over the free nodes
/// reads them. The topology has them in two tables, the second of which such a sweep reads here and
/// there: the weighted Laplacian took three times as long in a mesh generator's order, half as long
/// again in a good one.
class CellsAroundNodes {
 public:
  /// Larger meshes (of 16 million tetrahedra) take the topology's tables, and no memory besides.
  static constexpr std::size_t most_entries = std::size_t{1} << 28;

  explicit CellsAroundNodes(std::size_t max_entries = most_entries) : max_entries_(max_entries) {}

  /// Makes the table, unless it is that of this topology already.
  void prepare(std::shared_ptr<const Topology> topology);

  /// Calls use(cells) with what for_each_batch takes: the cells around a free node. position: the
  /// node's among the free ones. Returns what it returns.
  template <class Use>
  auto with_cells(std::size_t position, const Use& use) const {
    const ListedCells cells(*topology_, topology_->node_cells(topology_->free_nodes()[position]));
    return rows_.empty() ? use(cells) : use(TabledCells{cells, &rows_, first_rows_[position]});
  }

 private:
  /// Cells whose nodes are rows of the table that follow each other.
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
  std::vector<RowOffset> first_rows_;  ///< of each free node
  CompressedRows<NodeIndex> rows_;     ///< empty: the topology's are taken
};

}  // namespace smoothfem
