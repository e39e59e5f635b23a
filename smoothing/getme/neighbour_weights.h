// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "smoothing/mesh/compressed_rows.h"
#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// The weights of GETMe adaptive (thesis, Eq. 4.3): w_j = sqrt(sum over neighbours n of q(E_n) /
/// (|N(j)| q(E_j))). N(j) are the other elements that share a node with E_j. A table of all N(j)
/// would be several times as large as the mesh (about 70 neighbours for each tetrahedron). Instead
/// the sums over the elements of each node are added up, and what they count too often is
/// subtracted. Elements that share k > 1 nodes with E_j (about 17 for a tetrahedron) count k - 1
/// times too often.
class NeighbourWeights {
 public:
  /// Finds the shared nodes, unless this was done for the same topology before. Collective in a
  /// part of a mesh, as compute().
  void prepare(std::shared_ptr<const Topology> topology);

  /// Computes the weights of these cells from the quality of all cells, which has to be positive.
  /// Elements without neighbours have weight 1. In a part of a mesh, all cells get their weights.
  void compute(std::span<const CellIndex> cells, const std::vector<double>& cell_quality);

  const std::vector<double>& weights() const { return weights_; }

 private:
  double weight(CellIndex cell, const std::vector<double>& cell_quality) const;
  void compute_in_part(const std::vector<double>& cell_quality);

  std::shared_ptr<const Topology> topology_;
  std::vector<std::uint32_t> n_neighbours_;  ///< |N(j)| of each cell
  /// For each cell, the others that share k > 1 nodes with it, and k - 1. Two bytes an entry:
  /// uncompressed rows would take half the memory of a run.
  CompressedRows<std::uint16_t> counted_too_often_;
  std::vector<std::uint8_t> is_needed_;  ///< nodes of the cells whose weights are computed
  std::vector<double> node_sums_;        ///< sums of the qualities of each node's cells
  std::vector<double> surplus_;          ///< in a part: what each cell's sums count too often
  std::vector<double> rounded_;          ///< in a part: quality of each cell
  std::vector<double> weights_;
};

}  // namespace smoothfem
