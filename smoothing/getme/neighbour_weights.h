// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "smoothing/mesh/compressed_rows.h"
#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// The weights of GETMe adaptive (thesis, Eq. 4.3): w_j = sqrt(sum over neighbours n of q(E_n) /
/// (|N(j)| q(E_j))), where N(j) are the other elements that share a node with E_j. A table of all
/// of them would be several times as large as the mesh (some 70 for each tetrahedron). The sums
/// over the elements of each node are enough, once what they count too often is taken off again:
/// elements that share k > 1 nodes with E_j, of which a tetrahedron has about 17, k - 1 times.
class NeighbourWeights {
 public:
  /// Looks up the shared nodes, unless it has done so for this topology before.
  void prepare(std::shared_ptr<const Topology> topology);

  /// Of these cells, from the quality of all, which has to be positive. Elements without neighbours
  /// have weight 1.
  void compute(std::span<const CellIndex> cells, const std::vector<double>& cell_quality);

  const std::vector<double>& weights() const { return weights_; }

 private:
  double weight(CellIndex cell, const std::vector<double>& cell_quality) const;

  std::shared_ptr<const Topology> topology_;
  std::vector<std::uint32_t> n_neighbours_;  ///< |N(j)| of each cell
  /// For each cell, the others that share k > 1 nodes with it, and k - 1, in two bytes each: plain
  /// numbers would take half the memory of a run.
  CompressedRows<std::uint16_t> counted_too_often_;
  std::vector<std::uint8_t> is_needed_;  ///< nodes of the cells whose weights are computed
  std::vector<double> node_sums_;        ///< of the qualities of each node's cells
  std::vector<double> weights_;
};

}  // namespace smoothfem
