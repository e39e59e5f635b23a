// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "smoothing/base/parallel.h"
#include "smoothing/mesh/mesh.h"
#include "smoothing/optimization/block_matrix.h"
#include "smoothing/optimization/cell_derivatives.h"
#include "smoothing/optimization/disjoint_groups.h"
#include "smoothing/quality/cell_targets.h"

namespace smoothfem {

/// The objective of mesh optimization by shape: a sum over all elements. Each adds the squared mean
/// of the inverse mean ratios of the corners that the mean ratio counts. Mesquite's shape
/// improvement wrapper minimizes it. The thesis (Eq. 1.3) prints the sum of 1/q, which has no
/// barrier on quadrilaterals: one of four corners may collapse while the mean of the ratios stays
/// away from zero. The objective is at least n_cells, and equal to it only if all elements are
/// regular. It is infinite if an element is invalid. If cells have targets, their shapes are
/// relative to these, and each cell adds a term for its size (target_derivatives.h).
template <int dim>
class ShapeObjective {
 public:
  /// The unknowns are the coordinates of the free nodes, in the order of topology.free_nodes().
  /// targets: null if there are none. size_weight: factor of the term for the size.
  explicit ShapeObjective(std::shared_ptr<const Topology> topology,
                          std::shared_ptr<const CellTargets<dim>> targets = nullptr,
                          double size_weight = 1.0);

  std::size_t n_unknown_nodes() const { return topology_->free_nodes().size(); }

  /// Returns the objective; infinity if a cell is invalid. coordinates: of all nodes.
  double value(std::span<const Point<dim>> coordinates) const;

  /// Makes a matrix with the Hessian's pattern, to be filled by derivatives() of this objective
  /// only.
  BlockMatrix<dim> make_hessian();

  /// Computes the gradient and the Hessian (or its model) at coordinates where the value is finite.
  /// Visits the cells twice: the other blocks are scaled by the sums of the diagonal blocks.
  void derivatives(std::span<const Point<dim>> coordinates, HessianModel model,
                   BlockVector<dim>& gradient, BlockMatrix<dim>& hessian) const;

 private:
  /// Calls work(b) for all blocks of cells; several threads take blocks that share no nodes.
  template <class Work>
  void for_disjoint_blocks(const Work& work) const {
    for (const auto& group : groups_)
      parallel_for(group.size(), [&](std::size_t i) { work(group[i]); });
  }

  std::shared_ptr<const Topology> topology_;
  std::shared_ptr<const CellTargets<dim>> targets_;
  double size_weight_;
  DisjointGroups groups_;               ///< groups of topology_->blocks() that share no nodes
  std::vector<std::uint32_t> unknown_;  ///< number of each free node; n_unknown_nodes for fixed
  /// Positions of the blocks of each cell's pairs of nodes p < q, and of their transposes.
  std::vector<std::vector<std::array<std::uint32_t, 2>>> positions_;
};

}  // namespace smoothfem
