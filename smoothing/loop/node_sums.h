#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include "smoothing/mesh/lanes.h"
#include "smoothing/mesh/parallel.h"

namespace smoothfem {

/// Four sums for each node of a mesh (a weighted place and its weight), added up cell by cell by
/// several threads with the same bits however many they are: each block of cells has sums of its
/// own over the nodes it uses, and these are added in the order of the blocks.
class NodeSums {
 public:
  /// All sums are zero afterwards.
  void prepare(const Topology& topology) {
    topology_ = &topology;
    totals_.assign(n_lanes * topology.n_nodes(), 0.0);
    blocks_.resize(topology.blocks().size());
    std::iota(blocks_.begin(), blocks_.end(), std::size_t{0});
  }

  /// Sets the sums of all nodes: add_block(b, sums) adds those of the cells of block b, with add().
  /// Several blocks at a time.
  template <class AddBlock>
  void compute(const AddBlock& add_block) {
    parallel_for_ranges(topology_->n_nodes(), grain_, [&](std::size_t first, std::size_t last) {
      std::fill(total(first), total(last), 0.0);
    });
    add_blocks(blocks_, add_block);
  }

  /// Sets the sums of some nodes: the same, for the blocks with cells that use them, ascending.
  /// add_block must add nothing to other nodes.
  template <class AddBlock>
  void compute_some(std::span<const NodeIndex> nodes, std::span<const std::size_t> blocks,
                    const AddBlock& add_block) {
    for (const NodeIndex i : nodes) std::fill(total(i), total(i + 1), 0.0);
    add_blocks(blocks, add_block);
  }

  /// Adds to the sums of a node, in a block's sums.
  static SMOOTHFEM_INLINE void add(double* block_sums, NodeIndex node, Lanes values) {
    double* const at = block_sums + n_lanes_signed * static_cast<std::ptrdiff_t>(node);
    store_lanes(load_lanes(at) + values, at);
  }

  /// The four sums of a node.
  const double* operator[](NodeIndex node) const { return totals_.data() + n_lanes * node; }

  /// Calls use(node, sums) for every node, by several threads.
  template <class Use>
  void for_each_node(const Use& use) const {
    parallel_for_ranges(topology_->n_nodes(), grain_, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        use(static_cast<NodeIndex>(i), (*this)[static_cast<NodeIndex>(i)]);
    });
  }

 private:
  static constexpr std::ptrdiff_t n_lanes_signed = n_lanes;
  static constexpr std::size_t grain_ = 512;  ///< nodes whose sums one thread adds at a time
  static constexpr std::size_t little_ = std::size_t{1} << 21;  ///< sums: 16 MiB

  double* total(std::size_t node) { return totals_.data() + n_lanes * node; }
  const CellBlock& block(std::size_t b) const { return topology_->blocks()[b]; }
  std::size_t n_sums(std::size_t b) const {
    return n_lanes * (block(b).last_node - block(b).first_node);
  }

  /// Some blocks at a time: their own sums take at most a quarter of the memory of all nodes' sums,
  /// unless that is little or a single block needs more. How many they are has no influence on the
  /// sums.
  template <class AddBlock>
  void add_blocks(std::span<const std::size_t> blocks, const AddBlock& add_block) {
    const std::size_t room = std::max(little_, totals_.size() / 4);
    std::vector<std::size_t> offsets;
    while (!blocks.empty()) {
      std::size_t size = 0;
      offsets.clear();
      for (const std::size_t b : blocks) {
        if (!offsets.empty() && size + n_sums(b) > room) break;
        offsets.push_back(size);
        size += n_sums(b);
      }
      if (parts_.size() < size) parts_.resize(size);
      const auto now = blocks.first(offsets.size());
      parallel_for(now.size(), [&](std::size_t k) {
        double* const part = parts_.data() + offsets[k];
        std::fill(part, part + n_sums(now[k]), 0.0);
        add_block(now[k],
                  part - n_lanes_signed * static_cast<std::ptrdiff_t>(block(now[k]).first_node));
      });
      add_parts(now, offsets);
      blocks = blocks.subspan(now.size());
    }
  }

  void add_parts(std::span<const std::size_t> blocks, std::span<const std::size_t> offsets) {
    std::size_t begin = topology_->n_nodes(), end = 0;
    for (const std::size_t b : blocks) {
      begin = std::min<std::size_t>(begin, block(b).first_node);
      end = std::max<std::size_t>(end, block(b).last_node);
    }
    if (begin >= end) return;
    parallel_for_ranges(end - begin, grain_, [&](std::size_t first, std::size_t last) {
      for (std::size_t k = 0; k < blocks.size(); ++k) {
        const CellBlock& one = block(blocks[k]);
        const std::size_t from = std::max<std::size_t>(begin + first, one.first_node);
        const std::size_t to = std::min<std::size_t>(begin + last, one.last_node);
        if (from >= to) continue;
        const double* const part = parts_.data() + offsets[k] + n_lanes * (from - one.first_node);
        double* const sums = total(from);
        for (std::size_t i = 0; i < n_lanes * (to - from); ++i) sums[i] += part[i];
      }
    });
  }

  const Topology* topology_ = nullptr;
  std::vector<double> totals_;
  std::vector<double> parts_;        ///< sums of the blocks that are being added
  std::vector<std::size_t> blocks_;  ///< 0, 1, ...: all of them
};

/// The weighted places of one cell's node, as NodeSums adds them, for n_lanes cells or for one.
SMOOTHFEM_INLINE std::array<Lanes, n_lanes> weighted_places(Vector2<Lanes> place, Lanes weight) {
  return transposed(weight * place.x, weight * place.y, weight, Lanes{});
}
SMOOTHFEM_INLINE std::array<Lanes, n_lanes> weighted_places(Vector3<Lanes> place, Lanes weight) {
  return transposed(weight * place.x, weight * place.y, weight * place.z, weight);
}
SMOOTHFEM_INLINE Lanes weighted_place(Vector2<double> place, double weight) {
  return Lanes{weight * place.x, weight * place.y, weight, 0.0};
}
SMOOTHFEM_INLINE Lanes weighted_place(Vector3<double> place, double weight) {
  return Lanes{weight * place.x, weight * place.y, weight * place.z, weight};
}
/// The mean place of these sums. Their weight, sums[dim], must not be zero.
template <int dim>
Point<dim> mean_place(const double* sums) {
  Point<dim> place;
  for (int d = 0; d < dim; ++d) place[d] = sums[d] / sums[dim];
  return place;
}

}  // namespace smoothfem
