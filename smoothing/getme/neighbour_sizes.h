// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/simd/cells.h"

namespace smoothfem {

/// Sizes that fit the neighbourhoods of cells: the mean over a cell's nodes of the mean size of the
/// cells around each node. The size of a cell is that of its mean node simplex (node_simplex_size).
/// Cell types with edges of equal length have similar sizes, so that they may be mixed. Sizes of
/// inverted cells count without their sign.
///
/// Source: the thesis' scaling "preserving the mean volume of all node tetrahedra" (Section 3.3).
/// Here "all" means all tetrahedra around the cell's nodes, not only its own.
template <int dim, int spacedim = dim>
class NeighbourSizes {
 public:
  /// Updates the sizes around all nodes of a mesh.
  void update(const Mesh<dim, spacedim>& mesh);
  /// Updates the sizes around some nodes only, of a mesh of the same topology.
  void update(const Mesh<dim, spacedim>& mesh, std::span<const NodeIndex> nodes);

  /// Returns the size of a cell. Its nodes have to be up to date.
  double of(std::span<const NodeIndex> nodes) const {
    double sum = 0.0;
    for (const NodeIndex i : nodes) sum += at_node_[i];
    return sum / static_cast<double>(nodes.size());
  }
  /// Returns the sizes of several cells, bitwise identical to those of single cells.
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
