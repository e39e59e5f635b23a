#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include "smoothing/base/parallel.h"
#include "smoothing/simd/lanes.h"

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
  }

  /// Sets the sums of all nodes: add_block(b, sums) adds those of the cells of block b to `sums`,
  /// with add(). Several blocks at a time.
  template <class AddBlock>
  void compute(const AddBlock& add_block) {
    std::vector<std::size_t> blocks(topology_->blocks().size());
    std::iota(blocks.begin(), blocks.end(), std::size_t{0});
    add_up(
        blocks, [](std::size_t from, std::size_t to, const auto& use) { use(from, to); },
        add_block);
  }

  /// Sets the sums of some nodes, ascending, from the cells that use them, ascending:
  /// add_cells(b, cells, sums) adds those of some of the cells, which are in block b, to these
  /// nodes only.
  template <class AddCells>
  void compute_some(std::span<const NodeIndex> nodes, std::span<const CellIndex> cells,
                    const AddCells& add_cells) {
    const auto cells_of = [&](std::size_t b) {
      return between(cells, block(b).first, block(b).last);
    };
    std::vector<std::size_t> blocks;
    for (std::size_t b = 0; b < topology_->blocks().size(); ++b)
      if (!cells_of(b).empty()) blocks.push_back(b);
    add_up(
        blocks,
        [&](std::size_t from, std::size_t to, const auto& use) {
          const auto now = between(nodes, from, to);
          for (std::size_t first = 0, last = 0; first < now.size(); first = last) {
            while (last < now.size() && now[last] - now[first] == last - first) ++last;
            use(now[first], now[last - 1] + std::size_t{1});
          }
        },
        [&](std::size_t b, double* sums) { add_cells(b, cells_of(b), sums); });
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

  const CellBlock& block(std::size_t b) const { return topology_->blocks()[b]; }
  std::size_t n_sums(std::size_t b) const {
    return n_lanes * (block(b).last_node - block(b).first_node);
  }
  /// Those of some ascending numbers that are in first .. last - 1.
  static std::span<const std::uint32_t> between(std::span<const std::uint32_t> numbers,
                                                std::size_t first, std::size_t last) {
    const auto begin = std::lower_bound(numbers.begin(), numbers.end(), first);
    return {begin, std::lower_bound(begin, numbers.end(), last)};
  }

  /// Sets the sums of the nodes that each_run has: each_run(from, to, use) calls use(first, last)
  /// for runs of these nodes among from .. to - 1. Some blocks at a time: their own sums take at
  /// most a quarter of the memory of all nodes' sums, unless that is little or a single block needs
  /// more. How many they are has no influence on the sums.
  template <class EachRun, class AddBlock>
  void add_up(std::span<const std::size_t> blocks, const EachRun& each_run,
              const AddBlock& add_block) {
    const std::size_t room = std::max(little_, totals_.size() / 4);
    std::size_t n_begun = 0;  // nodes whose sums begin with zero when they are met first
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
        double* const sums = sums_of(now[k], offsets[k]);
        set_zero(sums, block(now[k]).first_node, block(now[k]).last_node, each_run);
        add_block(now[k], sums);
      });
      n_begun = add_parts(now, offsets, n_begun, each_run);
      blocks = blocks.subspan(now.size());
    }
    set_zero(totals_.data(), n_begun, topology_->n_nodes(), each_run);
  }

  template <class EachRun>
  static void set_zero(double* sums, std::size_t from, std::size_t to, const EachRun& each_run) {
    if (from >= to) return;
    each_run(from, to, [&](std::size_t first, std::size_t last) {
      std::fill(sums + signed_lanes(first), sums + signed_lanes(last), 0.0);
    });
  }

  /// Returns how many nodes have begun then.
  template <class EachRun>
  std::size_t add_parts(std::span<const std::size_t> blocks, std::span<const std::size_t> offsets,
                        std::size_t n_begun, const EachRun& each_run) {
    std::size_t begin = n_begun, end = n_begun;
    for (const std::size_t b : blocks) {
      begin = std::min<std::size_t>(begin, block(b).first_node);
      end = std::max<std::size_t>(end, block(b).last_node);
    }
    parallel_for_ranges(end - begin, grain_, [&](std::size_t from, std::size_t to) {
      set_zero(totals_.data(), std::max(begin + from, n_begun), begin + to, each_run);
      for (std::size_t k = 0; k < blocks.size(); ++k) {
        const CellBlock& one = block(blocks[k]);
        const double* const sums = sums_of(blocks[k], offsets[k]);
        each_run(std::max<std::size_t>(begin + from, one.first_node),
                 std::min<std::size_t>(begin + to, one.last_node),
                 [&](std::size_t first, std::size_t last) {
                   double* const totals = totals_.data();
                   for (auto i = signed_lanes(first); i < signed_lanes(last); ++i)
                     totals[i] += sums[i];
                 });
      }
    });
    return end;
  }

  static std::ptrdiff_t signed_lanes(std::size_t node) {
    return n_lanes_signed * static_cast<std::ptrdiff_t>(node);
  }
  /// Where the sums of node 0 would be among a block's own sums, which are at an offset in parts_.
  double* sums_of(std::size_t b, std::size_t offset) {
    return parts_.data() +
           (static_cast<std::ptrdiff_t>(offset) - signed_lanes(block(b).first_node));
  }

  const Topology* topology_ = nullptr;
  std::vector<double> totals_;
  std::vector<double> parts_;  ///< own sums of the blocks that are being added
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
