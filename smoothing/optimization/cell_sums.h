// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "smoothing/base/parallel.h"
#include "smoothing/mesh/parallel_rows.h"
#include "smoothing/mesh/topology.h"
#include "smoothing/optimization/added_block.h"
#include "smoothing/optimization/block_matrix.h"
#include "smoothing/optimization/disjoint_groups.h"
#include "smoothing/simd/cells.h"

namespace smoothfem {

/// Marks the block of a pair with a fixed node.
inline constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();

/// Cells in the form that the sums below take: several of a fixed type, or one cell.
template <std::size_t n>
const NodeIndex* nodes_of(const CellBatch<n>& batch, std::size_t l) {
  return batch.nodes[l];
}
struct SingleCell {
  std::span<const NodeIndex> nodes;

  template <class Visit>
  void for_each_lane(const Visit& visit) const {
    visit(std::size_t{0});
  }
};
inline const NodeIndex* nodes_of(const SingleCell& cell, std::size_t) {
  return cell.nodes.data();
}

/// One of several cells at a time.
template <class Cells>
struct OneLane {
  const Cells& cells;
  std::size_t lane;

  template <class Visit>
  void for_each_lane(const Visit& visit) const {
    visit(lane);
  }
};
template <class Cells>
const NodeIndex* nodes_of(const OneLane<Cells>& one, std::size_t l) {
  return nodes_of(one.cells, l);
}

/// Calls add(cells), or for each of them separately: then the order of sums does not depend on how
/// many there are at a time.
template <class Cells, class Add>
void add_in_order(bool one_by_one, const Cells& cells, const Add& add) {
  if (!one_by_one) return add(cells);
  cells.for_each_lane([&](std::size_t l) { add(OneLane<Cells>{cells, l}); });
}

/// Adds the gradients of cells and the diagonal blocks of their Hessians. The order of the cells,
/// and so of these sums, is always the same.
template <int dim>
struct DiagonalSums {
  static constexpr HessianBlocks blocks = HessianBlocks::diagonal;
  const std::vector<std::uint32_t>& unknown;
  bool one_by_one;
  BlockVector<dim>& gradient;
  std::vector<typename BlockMatrix<dim>::Block>& diagonal;

  template <class Cells, class Derivatives>
  void add(const Cells& cells, const Derivatives& cell) {
    add_in_order(one_by_one, cells, [&](const auto& some) { add_some(some, cell); });
  }

 private:
  template <class Cells, class Derivatives>
  void add_some(const Cells& cells, const Derivatives& cell) {
    const std::size_t n = cell.gradient.size();
    for (std::size_t p = 0; p < n; ++p) {
      const auto blocks_of_cells = added_blocks<double>(cell.hessian[node_pair(n, p, p)]);
      cells.for_each_lane([&](std::size_t l) {
        const std::uint32_t row = unknown[nodes_of(cells, l)[p]];
        if (row >= gradient.size()) return;
        gradient[row] += lane(cell.gradient[p], l);
        blocks_of_cells[l].add_to(diagonal[row].data());
      });
    }
  }
};

/// Adds the other blocks, scaled, in the same order.
template <int dim>
struct OtherBlockSums {
  static constexpr HessianBlocks blocks = HessianBlocks::all;
  const std::vector<std::uint32_t>& unknown;
  bool one_by_one;
  const std::array<std::uint32_t, 2>* positions;  ///< in the matrix, of the next cell's pairs
  BlockMatrix<dim>& hessian;

  template <class Cells, class Derivatives>
  void add(const Cells& cells, const Derivatives& cell) {
    const std::size_t n_pairs = n_node_pairs(cell.gradient.size()) - cell.gradient.size();
    add_in_order(one_by_one, cells, [&](const auto& some) { add_some(some, cell, n_pairs); });
    cells.for_each_lane([&](std::size_t) { positions += n_pairs; });
  }

 private:
  template <class Cells, class Derivatives>
  void add_some(const Cells& cells, const Derivatives& cell, std::size_t n_pairs) {
    const std::size_t n = cell.gradient.size();
    typename Derivatives::NodeBlocks factors(n);
    for (std::size_t p = 0; p < n; ++p)
      cells.for_each_lane([&](std::size_t l) {
        const double* const factor = hessian.inverse_factor(unknown[nodes_of(cells, l)[p]]).data();
        for (std::size_t i = 0; i < dim * dim; ++i) set_lane(factors[p].entries[i], l, factor[i]);
      });
    const auto* pair = positions;
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t q = p + 1; q < n; ++q, ++pair) {
        const auto blocks_of_cells = added_blocks<typename BlockMatrix<dim>::Number>(
            scaled<dim>(factors[p], cell.hessian[node_pair(n, p, q)], factors[q]));
        cells.for_each_lane([&](std::size_t l) {
          const auto [right, left] = pair[l * n_pairs];
          if (right == nowhere) return;
          blocks_of_cells[l].add_to(hessian.scaled_block(right));
          blocks_of_cells[l].transpose().add_to(hessian.scaled_block(left));
        });
      }
  }
};

/// The unknowns of an objective that is a sum over cells, and the sums of its derivatives. The
/// unknowns are the coordinates of some nodes. In a part of a mesh, the sums of the nodes that it
/// owns are complete. There one thread adds the cells in their order, so that the sums do not
/// depend on the parts.
template <int dim>
class CellSums {
 public:
  /// unknown_nodes: ascending. cells: all nodes of each cell of the topology.
  CellSums(const Topology& topology, std::vector<NodeIndex> unknown_nodes,
           const CompressedRows<NodeIndex>& cells)
      : blocks_(&topology.blocks()),
        cells_(&cells),
        unknown_nodes_(std::move(unknown_nodes)),
        rows_(topology, unknown_nodes_),
        unknown_(topology.n_nodes(), static_cast<std::uint32_t>(unknown_nodes_.size())) {
    std::uint32_t next = 0;
    for (const NodeIndex i : unknown_nodes_) unknown_[i] = next++;
    // Cells of second order that share a midside node share corners, too.
    const auto corners = [&](std::size_t b) {
      return IndexRange{(*blocks_)[b].first_node, (*blocks_)[b].last_node};
    };
    groups_ = disjoint_groups(blocks_->size(), corners, corners);
  }

  const std::vector<NodeIndex>& unknown_nodes() const { return unknown_nodes_; }

  /// Makes a matrix with the Hessian's pattern, to be filled by derivatives() of this object only.
  /// node_cells(i): the cells of a node.
  template <class NodeCells>
  BlockMatrix<dim> make_hessian(const NodeCells& node_cells) {
    BlockMatrix<dim> matrix(coupled_unknowns(node_cells), rows_);
    const auto fixed = static_cast<std::uint32_t>(unknown_nodes_.size());
    positions_.resize(blocks_->size());
    parallel_for(positions_.size(), [&](std::size_t b) {
      const CellBlock& block = (*blocks_)[b];
      positions_[b].clear();
      for (CellIndex c = block.first; c < block.last; ++c) {
        const auto nodes = (*cells_)[c];
        for (std::size_t p = 0; p < nodes.size(); ++p)
          for (std::size_t q = p + 1; q < nodes.size(); ++q) {
            const std::uint32_t i = unknown_[nodes[p]], j = unknown_[nodes[q]];
            if (i == fixed || j == fixed)
              positions_[b].push_back({nowhere, nowhere});
            else
              positions_[b].push_back({matrix.position(i, j), matrix.position(j, i)});
          }
      }
    });
    return matrix;
  }

  /// Computes the gradient and the Hessian. Visits the cells twice: the other blocks are scaled by
  /// the sums of the diagonal blocks. add_block(block, sums): calls sums.add(cells, derivatives)
  /// for all cells of a block in their order, with the derivatives that `sums` has as `blocks`.
  template <class AddBlock>
  void derivatives(const AddBlock& add_block, BlockVector<dim>& gradient,
                   BlockMatrix<dim>& hessian) const {
    std::fill(gradient.begin(), gradient.end(), Point<dim>::Zero());
    const bool one_by_one = rows_.part() != nullptr;
    auto diagonal = hessian.start_diagonal();
    for_disjoint_blocks([&](std::size_t b) {
      add_block((*blocks_)[b], DiagonalSums<dim>{unknown_, one_by_one, gradient, diagonal});
    });
    hessian.factor_diagonal(std::move(diagonal));
    for_disjoint_blocks([&](std::size_t b) {
      add_block((*blocks_)[b],
                OtherBlockSums<dim>{unknown_, one_by_one, positions_[b].data(), hessian});
    });
  }

 private:
  /// Returns for each unknown the unknowns it shares a cell with.
  template <class NodeCells>
  CompressedRows<std::uint32_t> coupled_unknowns(const NodeCells& node_cells) const {
    const std::size_t n = unknown_nodes_.size();
    return make_rows<std::uint32_t>(n, [&](std::size_t i, std::vector<std::uint32_t>& row) {
      for (const CellIndex c : node_cells(unknown_nodes_[i]))
        for (const NodeIndex j : (*cells_)[c])
          if (unknown_[j] < n) row.push_back(unknown_[j]);
      std::sort(row.begin(), row.end());
      row.erase(std::unique(row.begin(), row.end()), row.end());
    });
  }

  /// Calls work(b) for all blocks of cells; several threads take blocks that share no nodes.
  template <class Work>
  void for_disjoint_blocks(const Work& work) const {
    if (rows_.part() != nullptr) {
      for (std::size_t b = 0; b < blocks_->size(); ++b) work(b);
      return;
    }
    for (const auto& group : groups_)
      parallel_for(group.size(), [&](std::size_t i) { work(group[i]); });
  }

  const std::vector<CellBlock>* blocks_;
  const CompressedRows<NodeIndex>* cells_;
  std::vector<NodeIndex> unknown_nodes_;
  UnknownRows rows_;
  DisjointGroups groups_;               ///< groups of blocks that share no nodes
  std::vector<std::uint32_t> unknown_;  ///< number of each unknown node; otherwise their count
  /// Positions of the blocks of each cell's pairs of nodes p < q, and of their transposes.
  std::vector<std::vector<std::array<std::uint32_t, 2>>> positions_;
};

}  // namespace smoothfem
