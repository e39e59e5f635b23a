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

namespace smoothfem {

/// The objective of mesh optimization by shape: the sum over all elements of the squared mean of
/// the inverse mean ratios of the element's corners (those that the mean ratio counts). That is
/// what Mesquite's shape improvement wrapper minimizes; the thesis (Eq. 1.3) prints the sum of 1/q,
/// which has no barrier on quadrilaterals: one of four corners may collapse while the mean of the
/// ratios stays away from zero. At least n_cells, equal only if all elements are regular; infinite
/// if an element is invalid.
template <int dim>
class ShapeObjective {
 public:
  /// Unknowns are the coordinates of the free nodes, in the order of topology.free_nodes().
  explicit ShapeObjective(std::shared_ptr<const Topology> topology);

  std::size_t n_unknown_nodes() const { return topology_->free_nodes().size(); }

  /// coordinates: of all nodes. Infinity if a cell is invalid.
  double value(std::span<const Point<dim>> coordinates) const;

  /// A matrix with the Hessian's pattern, to be filled by derivatives() of this objective only.
  BlockMatrix<dim> make_hessian();

  /// Gradient and Hessian (or the model of it) at coordinates where value is finite. Goes over the
  /// cells twice: other blocks are scaled by what the diagonal ones add up to.
  void derivatives(std::span<const Point<dim>> coordinates, HessianModel model,
                   BlockVector<dim>& gradient, BlockMatrix<dim>& hessian) const;

 private:
  /// Calls work(b) for all blocks of cells, those that share no nodes by several threads.
  template <class Work>
  void for_disjoint_blocks(const Work& work) const {
    for (const auto& group : groups_)
      parallel_for(group.size(), [&](std::size_t i) { work(group[i]); });
  }

  std::shared_ptr<const Topology> topology_;
  DisjointGroups groups_;               ///< of topology_->blocks() that share no nodes
  std::vector<std::uint32_t> unknown_;  ///< number of each free node; n_unknown_nodes for fixed
  /// Where the blocks of each cell's pairs of nodes p < q go, and their transposes.
  std::vector<std::vector<std::array<std::uint32_t, 2>>> positions_;
};

}  // namespace smoothfem
