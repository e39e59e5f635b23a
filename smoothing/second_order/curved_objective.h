// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/optimization/cell_derivatives.h"
#include "smoothing/optimization/cell_sums.h"
#include "smoothing/second_order/reference_rules.h"

namespace smoothfem {

/// Returns the nodes that may move if midside nodes move by themselves, ascending: the free corners
/// of the topology, and all midside nodes but three kinds. Nodes on facets of the boundary and of
/// interfaces stay. So do nodes that are fixed for another reason, and nodes of edges, faces and
/// cells whose corners are all fixed, one of them for another reason.
std::vector<NodeIndex> free_nodes_of_second_order(const Topology& topology);

/// The objective of mesh optimization on curved cells, a sum over cells of
///
///   mean(f^2) + straightness mean(|S - S'|^2) / |mean(S)|^2,
///   f = |S|^2 / (dim det(S)^(2/dim)),   S = J W^-1,
///
/// with the Jacobian J of the cell's mapping from the reference element, that of the ideal cell W,
/// the inverse mean ratio f of inverse_mean_ratio.h, and S' of the cell with the same corners and
/// straight edges. Means over the ideal cell are sums over the points of reference_rules.h. The
/// objective is infinite if det J is not positive at one of these points, or if a cell of second
/// order is not proven valid (jacobian_bounds.h). Affine cells have the same f everywhere and add
/// as much as in ShapeObjective.
///
/// The first term sees shapes of angles only: f is 1 everywhere also for a conformal mapping. The
/// second one, the bending, is 0 for straight cells. It holds the second derivatives of the mapping
/// down, and with them the error of isoparametric interpolation.
///
/// Linear cells and polygons of the mesh add the mean of f^2 over their corners. They are valid if
/// det J is positive there, as for all methods.
///
/// Sources: Knupp, Introducing the target-matrix paradigm for mesh optimization via node-movement,
/// Engineering with Computers 28 (2012); Dobrev, Knupp, Kolev, Mittal, Tomov, The target-matrix
/// optimization paradigm for high-order meshes, SIAM J. Sci. Comput. 41 (2019); for the integral of
/// the squared distortion over curved cells: Gargallo-Peiro, Roca, Peraire, Sarrate, Optimization
/// of a regularized distortion measure to generate curved high-order unstructured tetrahedral
/// meshes, International Journal for Numerical Methods in Engineering 103 (2015); for the error:
/// Ciarlet, Raviart, Interpolation theory over curved elements, with applications to finite element
/// methods, Computer Methods in Applied Mechanics and Engineering 1 (1972).
template <int dim>
class CurvedObjective {
 public:
  /// The unknowns are the coordinates of free_nodes_of_second_order().
  /// straightness: at least 0.
  CurvedObjective(std::shared_ptr<const Topology> topology, double straightness);
  CurvedObjective(const CurvedObjective&) = delete;
  CurvedObjective& operator=(const CurvedObjective&) = delete;

  const std::vector<NodeIndex>& unknown_nodes() const { return sums_.unknown_nodes(); }

  /// Returns the objective; infinity if a cell is invalid. coordinates: of all nodes.
  double value(std::span<const Point<dim>> coordinates) const;

  /// Makes a matrix with the Hessian's pattern, to be filled by derivatives() of this objective
  /// only.
  BlockMatrix<dim> make_hessian();

  /// Computes the gradient and the Hessian (or its model) at coordinates where the value is finite.
  void derivatives(std::span<const Point<dim>> coordinates, HessianModel model,
                   BlockVector<dim>& gradient, BlockMatrix<dim>& hessian) const;

  /// Limits the movement of nodes on straight lines, as feasible_fractions() does: a node may go as
  /// far as each of its cells can go as a whole. There the cell must be valid, and det J at each
  /// point must have lost no more than `fraction`. Limits are powers of 1/2; 0 if even a thousandth
  /// of the way is too far. Returns the smallest limit.
  double limits(std::span<const Point<dim>> from, std::span<const Point<dim>> to, double fraction,
                std::vector<double>& limits) const;

 private:
  bool is_curved(CellIndex cell) const { return !topology_->midside_nodes(cell).empty(); }
  double cell_value(CellIndex cell, std::span<const Point<dim>> coordinates) const;
  double cell_limit(CellIndex cell, std::span<const Point<dim>> from,
                    std::span<const Point<dim>> to, double fraction) const;

  std::shared_ptr<const Topology> topology_;
  double straightness_;
  CompressedRows<NodeIndex> cells_;                                     ///< all nodes of each cell
  std::map<std::pair<std::size_t, std::size_t>, CellRule<dim>> rules_;  ///< by corners, midside
  std::vector<const CellRule<dim>*> rule_of_cells_;
  CellSums<dim> sums_;
};

}  // namespace smoothfem
