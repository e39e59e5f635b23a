// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/simd/cells.h"

namespace smoothfem {

/// The size that fits a cell's neighbourhood: the mean over its nodes of the mean size of the cells
/// around each of them. A cell's size is that of its mean node simplex (node_simplex_size), which
/// is much the same for all types of cells with edges of one length, so that they may be mixed.
/// Sizes of cells that are turned inside out count without their sign.
///
/// The thesis' scaling "preserving the mean volume of all node tetrahedra" (Section 3.3) read with
/// "all" meant: all those around a cell's nodes, not its own only.
template <int dim, int spacedim = dim>
class NeighbourSizes {
 public:
  /// Looks at all cells of a mesh.
  void update(const Mesh<dim, spacedim>& mesh);
  /// The same for some nodes only, of a mesh of the same topology.
  void update(const Mesh<dim, spacedim>& mesh, std::span<const NodeIndex> nodes);

  /// Of a cell, whose nodes have to be up to date.
  double of(std::span<const NodeIndex> nodes) const {
    double sum = 0.0;
    for (const NodeIndex i : nodes) sum += at_node_[i];
    return sum / static_cast<double>(nodes.size());
  }
  /// Of several cells; the same bits.
  template <std::size_t n>
  Lanes of(const CellBatch<n>& batch) const {
    Lanes sum{};
    unrolled<n>([&](auto k) {
      sum += Lanes{at_node_[batch.nodes[0][k]], at_node_[batch.nodes[1][k]],
                   at_node_[batch.nodes[2][k]], at_node_[batch.nodes[3][k]]};
    });
    return sum / static_cast<double>(n);
  }

 private:
  std::vector<double> of_cell_;
  std::vector<double> at_node_;  ///< mean over the cells around each node
};

}  // namespace smoothfem
