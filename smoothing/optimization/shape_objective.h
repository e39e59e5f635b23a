// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/optimization/cell_derivatives.h"
#include "smoothing/optimization/cell_sums.h"
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
  /// The unknowns are the coordinates of the nodes that are not fixed, in their order.
  /// targets: null if there are none. size_weight: factor of the term for the size.
  explicit ShapeObjective(std::shared_ptr<const Topology> topology,
                          std::shared_ptr<const CellTargets<dim>> targets = nullptr,
                          double size_weight = 1.0);

  const std::vector<NodeIndex>& unknown_nodes() const { return sums_.unknown_nodes(); }

  /// Returns the objective of the whole mesh; infinity if a cell is invalid. coordinates: of all
  /// nodes.
  double value(std::span<const Point<dim>> coordinates) const;

  /// Makes a matrix with the Hessian's pattern, to be filled by derivatives() of this objective
  /// only.
  BlockMatrix<dim> make_hessian();

  /// Computes the gradient and the Hessian (or its model) at coordinates where the value is finite.
  void derivatives(std::span<const Point<dim>> coordinates, HessianModel model,
                   BlockVector<dim>& gradient, BlockMatrix<dim>& hessian) const;

 private:
  std::shared_ptr<const Topology> topology_;
  std::shared_ptr<const CellTargets<dim>> targets_;
  double size_weight_;
  CellSums<dim> sums_;
};

}  // namespace smoothfem
