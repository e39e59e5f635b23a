#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "smoothing/mesh/lanes.h"
#include "smoothing/mesh/parallel.h"

namespace smoothfem {

/// Four sums for each node of a mesh (a weighted place and its weight), added up cell by cell by
/// several threads with the same bits however many they are: each block of cells has sums of its
/// own over the nodes it uses, and these are added in the order of the blocks.
class NodeSums {
 public:
  void prepare(const Topology& topology) {
    topology_ = &topology;
    offsets_.clear();
    std::size_t size = 0;
    for (const CellBlock& block : topology.blocks()) {
      offsets_.push_back(size);
      size += n_lanes * (block.last_node - block.first_node);
    }
    sums_.resize(size);
  }

  /// Sets the sums of a block to zero and returns where those of node i are: at 4 i of the result.
  double* start_block(std::size_t b) {
    const CellBlock& block = topology_->blocks()[b];
    double* const begin = sums_.data() + offsets_[b];
    std::fill(begin, begin + n_lanes * (block.last_node - block.first_node), 0.0);
    return of_block(b);
  }
  double* of_block(std::size_t b) {
    const std::ptrdiff_t first_node = topology_->blocks()[b].first_node;
    return sums_.data() + (static_cast<std::ptrdiff_t>(offsets_[b]) - n_lanes_signed * first_node);
  }
  /// Sets the sums of one node in a block to zero, if it has any there.
  void clear(std::size_t b, NodeIndex node) {
    const CellBlock& block = topology_->blocks()[b];
    if (node < block.first_node || node >= block.last_node) return;
    store_lanes(Lanes{}, of_block(b) + n_lanes_signed * static_cast<std::ptrdiff_t>(node));
  }
  /// Adds to the sums of a node, in a block's sums.
  static SMOOTHFEM_INLINE void add(double* block_sums, NodeIndex node, Lanes values) {
    double* const at = block_sums + n_lanes_signed * static_cast<std::ptrdiff_t>(node);
    store_lanes(load_lanes(at) + values, at);
  }

  /// Calls use(node, sums) for every node, with four doubles a node, by several threads.
  template <class Use>
  void for_each_node(const Use& use) const {
    const auto& blocks = topology_->blocks();
    parallel_for_ranges(topology_->n_nodes(), grain_, [&](std::size_t first, std::size_t last) {
      std::array<double, n_lanes * grain_> totals{};
      for (std::size_t b = 0; b < blocks.size(); ++b) {
        const std::size_t from = std::max<std::size_t>(first, blocks[b].first_node);
        const std::size_t to = std::min<std::size_t>(last, blocks[b].last_node);
        if (from >= to) continue;
        const double* const part =
            sums_.data() + offsets_[b] + n_lanes * (from - blocks[b].first_node);
        double* const total = totals.data() + n_lanes * (from - first);
        for (std::size_t i = 0; i < n_lanes * (to - from); ++i) total[i] += part[i];
      }
      for (std::size_t i = first; i < last; ++i)
        use(static_cast<NodeIndex>(i), totals.data() + n_lanes * (i - first));
    });
  }

 private:
  static constexpr std::ptrdiff_t n_lanes_signed = n_lanes;
  static constexpr std::size_t grain_ = 512;  ///< nodes whose sums one thread adds at a time

  const Topology* topology_ = nullptr;
  std::vector<std::size_t> offsets_;
  std::vector<double> sums_;
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
