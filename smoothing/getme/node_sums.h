// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "smoothing/base/parallel.h"
#include "smoothing/mesh/topology.h"
#include "smoothing/simd/lanes.h"

namespace smoothfem {

/// Four sums for each node of a mesh (weighted coordinates and the weight), added up cell by cell
/// by several threads. Results are bitwise identical for every number of threads: each block of
/// cells has separate sums over its nodes, and these are added in the order of the blocks.
class NodeSums {
 public:
  /// Sets all sums to zero.
  void prepare(const Topology& topology) {
    topology_ = &topology;
    totals_.assign(n_lanes * topology.n_nodes(), 0.0);
  }

  /// Returns the four sums of a node.
  const double* operator[](NodeIndex node) const { return totals_.data() + n_lanes * node; }

  /// Adds to the sums of a node among the sums of a block.
  static void add(double* block_sums, NodeIndex node, Lanes values) {
    double* const sums = block_sums + offset_of(node);
    store_lanes(load_lanes(sums) + values, sums);
  }

  /// Computes the sums of all nodes. add_block(b, sums) adds those of the cells of block b to
  /// `sums` by add(). Several blocks run at a time.
  template <class AddBlock>
  void compute(const AddBlock& add_block) {
    std::vector<std::size_t> blocks(topology_->blocks().size());
    std::iota(blocks.begin(), blocks.end(), std::size_t{0});
    const auto each_node = [](std::size_t from, std::size_t to, const auto& use) {
      for (std::size_t i = from; i < to; ++i) use(i);
    };
    add_up(blocks, each_node, add_block);
  }

  /// Computes the sums of some nodes (ascending) from the cells that use them (ascending).
  /// add_cells(b, cells, sums) adds those of the given cells of block b, to these nodes only.
  template <class AddCells>
  void compute_some(std::span<const NodeIndex> nodes, std::span<const CellIndex> cells,
                    const AddCells& add_cells) {
    const auto cells_of = [&](std::size_t b) {
      return between(cells, block(b).first, block(b).last);
    };
    std::vector<std::size_t> blocks;
    for (std::size_t b = 0; b < topology_->blocks().size(); ++b)
      if (!cells_of(b).empty()) blocks.push_back(b);
    const auto each_node = [&](std::size_t from, std::size_t to, const auto& use) {
      for (const NodeIndex i : between(nodes, from, to)) use(i);
    };
    add_up(blocks, each_node,
           [&](std::size_t b, double* sums) { add_cells(b, cells_of(b), sums); });
  }

 private:
  static constexpr std::size_t grain = 512;  ///< nodes whose sums one thread adds at a time
  static constexpr std::size_t min_buffer = std::size_t{1} << 21;  ///< sums: 16 MiB

  static std::ptrdiff_t offset_of(std::size_t node) {
    return static_cast<std::ptrdiff_t>(n_lanes * node);
  }
  const CellBlock& block(std::size_t b) const { return topology_->blocks()[b]; }
  std::size_t n_sums(std::size_t b) const {
    return n_lanes * (block(b).last_node - block(b).first_node);
  }
  /// Returns the part of some ascending numbers that lies in first .. last - 1.
  static std::span<const std::uint32_t> between(std::span<const std::uint32_t> numbers,
                                                std::size_t first, std::size_t last) {
    if (first >= last) return {};
    const auto begin = std::lower_bound(numbers.begin(), numbers.end(), first);
    return {begin, std::lower_bound(begin, numbers.end(), last)};
  }
  /// Returns the address of the sums of node 0 among a block's separate sums, which begin at an
  /// offset in parts_.
  double* sums_of(std::size_t b, std::size_t offset) {
    return parts_.data() + (static_cast<std::ptrdiff_t>(offset) - offset_of(block(b).first_node));
  }

  /// Computes the sums of the nodes of each_node: each_node(from, to, use) calls use(i) for its
  /// nodes in from .. to - 1. Some blocks run at a time. Their separate sums take at most a quarter
  /// of the memory of all nodes' sums, unless that is little or a single block needs more. The
  /// number of blocks at a time does not change the sums.
  template <class EachNode, class AddBlock>
  void add_up(std::span<const std::size_t> blocks, const EachNode& each_node,
              const AddBlock& add_block) {
    const std::size_t buffer_size = std::max(min_buffer, totals_.size() / 4);
    const auto set_zero = [&](double* sums, std::size_t from, std::size_t to) {
      each_node(from, to, [&](std::size_t i) { store_lanes(Lanes{}, sums + offset_of(i)); });
    };
    std::size_t n_begun = 0;  // nodes 0 .. n_begun - 1 have totals of the blocks so far
    std::vector<std::size_t> offsets;
    while (!blocks.empty()) {
      std::size_t size = 0;
      offsets.clear();
      for (const std::size_t b : blocks) {
        if (!offsets.empty() && size + n_sums(b) > buffer_size) break;
        offsets.push_back(size);
        size += n_sums(b);
      }
      if (parts_.size() < size) parts_.resize(size);
      const auto now = blocks.first(offsets.size());
      std::size_t begin = n_begun, end = n_begun;
      for (const std::size_t b : now) {
        begin = std::min<std::size_t>(begin, block(b).first_node);
        end = std::max<std::size_t>(end, block(b).last_node);
      }
      parallel_for(now.size(), [&](std::size_t k) {
        double* const sums = sums_of(now[k], offsets[k]);
        set_zero(sums, block(now[k]).first_node, block(now[k]).last_node);
        add_block(now[k], sums);
      });
      parallel_for_ranges(end - begin, grain, [&](std::size_t first, std::size_t last) {
        const std::size_t from = begin + first, to = begin + last;
        set_zero(totals_.data(), std::max(from, n_begun), to);
        for (std::size_t k = 0; k < now.size(); ++k) {
          const double* const sums = sums_of(now[k], offsets[k]);
          each_node(std::max<std::size_t>(from, block(now[k]).first_node),
                    std::min<std::size_t>(to, block(now[k]).last_node), [&](std::size_t i) {
                      double* const total = totals_.data() + offset_of(i);
                      store_lanes(load_lanes(total) + load_lanes(sums + offset_of(i)), total);
                    });
        }
      });
      n_begun = end;
      blocks = blocks.subspan(now.size());
    }
    set_zero(totals_.data(), n_begun, topology_->n_nodes());
  }

  const Topology* topology_ = nullptr;
  std::vector<double> totals_;
  std::vector<double> parts_;  ///< separate sums of the blocks that are being added
};

}  // namespace smoothfem
