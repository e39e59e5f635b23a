#pragma once

#include <limits>
#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/smoothers/block_matrix.h"
#include "smoothing/smoothers/cell_derivatives.h"

namespace smoothfem {

/// The objective of mesh optimization by shape: the sum over all elements of the squared mean of
/// the inverse mean ratios of the element's corners. That is what Mesquite's shape improvement
/// wrapper minimizes; the thesis (Eq. 1.3) prints the sum of 1/q, which has no barrier on
/// quadrilaterals: one of four corners may collapse while the mean of the ratios stays away from
/// zero. At least n_cells, equal only if all elements are regular; infinite if an element is
/// invalid.
class ShapeObjective {
 public:
  /// Unknowns are the places of the free nodes, in the order of topology.free_nodes().
  explicit ShapeObjective(std::shared_ptr<const Topology> topology);

  std::size_t n_unknown_nodes() const { return topology_->free_nodes().size(); }

  /// coordinates: of all nodes. Infinity if a cell is invalid.
  double value(const std::vector<Point<2>>& coordinates) const;

  /// Gradient and Hessian (or the model of it) at coordinates where value is finite.
  void derivatives(const std::vector<Point<2>>& coordinates, HessianModel model,
                   BlockVector& gradient, BlockMatrix& hessian) const;

  /// A matrix with the Hessian's pattern.
  BlockMatrix make_hessian() const;

 private:
  void build_pattern();
  template <class Real, std::size_t extent>
  void scatter(CellIndex first, const CellDerivatives<Real, extent>& cell, BlockVector& gradient,
               BlockMatrix& hessian) const;

  std::shared_ptr<const Topology> topology_;
  std::vector<std::uint32_t> unknown_;     ///< number of each free node; n_unknown_nodes for fixed
  CompressedRows<std::uint32_t> pattern_;  ///< unknowns that share a cell
  CompressedRows<std::uint32_t> block_positions_;  ///< n x n for each cell
};

}  // namespace smoothfem
