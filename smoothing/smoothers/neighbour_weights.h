#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "smoothing/mesh/parallel.h"
#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// The weights of GETMe adaptive (thesis, Eq. 4.3): w_j = sqrt(sum over neighbours n of q(E_n) /
/// (|N(j)| q(E_j))), where N(j) are the other elements that share a node with E_j. Neighbours are
/// looked up anew every time: a table of them would be several times as large as the mesh (some 70
/// for each tetrahedron).
class NeighbourWeights {
 public:
  void prepare(const Topology& topology) {
    topology_ = &topology;
    weights_.assign(topology.n_cells(), 1.0);
    visitors_.assign(static_cast<std::size_t>(n_threads()), {});
  }

  /// Of these cells, from the quality of all, which has to be positive. Elements without neighbours
  /// have weight 1.
  void compute(std::span<const CellIndex> cells, const std::vector<double>& cell_quality) {
    constexpr std::size_t grain = 2048;
    parallel_for_ranges(cells.size(), grain, [&](std::size_t first, std::size_t last) {
      Visitor& visitor = visitors_[static_cast<std::size_t>(thread_number())];
      if (visitor.stamps.empty()) visitor.stamps.assign(topology_->n_cells(), 0);
      for (std::size_t i = first; i < last; ++i)
        weights_[cells[i]] = weight(cells[i], cell_quality, visitor);
    });
  }

  const std::vector<double>& weights() const { return weights_; }

 private:
  /// What a thread remembers: in which search a cell was met last.
  struct Visitor {
    std::vector<std::uint32_t> stamps;
    std::uint32_t search = 0;
  };

  double weight(CellIndex cell, const std::vector<double>& cell_quality, Visitor& visitor) const {
    if (++visitor.search == 0) {  // all stamps are used up
      std::fill(visitor.stamps.begin(), visitor.stamps.end(), 0);
      visitor.search = 1;
    }
    visitor.stamps[cell] = visitor.search;
    double sum = 0.0;
    std::uint32_t count = 0;
    for (const NodeIndex node : topology_->cell_nodes(cell))
      for (const CellIndex other : topology_->node_cells(node)) {
        // Without a branch, which could not be foreseen.
        const bool is_new = visitor.stamps[other] != visitor.search;
        visitor.stamps[other] = visitor.search;
        sum += is_new ? cell_quality[other] : 0.0;
        count += is_new ? 1 : 0;
      }
    return count == 0 ? 1.0 : std::sqrt(sum / (count * cell_quality[cell]));
  }

  const Topology* topology_ = nullptr;
  std::vector<double> weights_;
  std::vector<Visitor> visitors_;
};

}  // namespace smoothfem
