// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "smoothing/getme/element_parameters.h"
#include "smoothing/loop/smoother.h"

namespace smoothfem {

/// The weighted means behind GETMe's averaging (thesis, Eq. 4.2): elements E_j are transformed to
/// E'_j, and a node gets the sums of w_j p' and of w_j over the elements it belongs to, p' being
/// its position in E'_j. Several elements at a time; the same bits for every number of threads.
template <int dim, int spacedim = dim>
class ElementPass {
 public:
  ElementPass();
  ~ElementPass();

  /// Call before a run; parameters: how elements are transformed.
  void prepare(const Topology& topology, const ElementParameters<dim>& parameters);

  /// Sizes that transformed elements get from now on, by their mean node simplices as in
  /// NeighbourSizes, for elements whose scaling fits the neighbours: each its own size in place of
  /// that. One for each element, positive; they have to last.
  void prescribe_sizes(std::span<const double> of_cells);

  /// Transforms all elements, with weights w_j = (1 - q(E_j))^eta. Writes the quality of each to
  /// state.cell_quality, and returns that of the mesh.
  MeshQuality transform_all(SmoothingState<dim, spacedim>& state, double eta);

  /// The same sums, for a mesh that differs from the one before in these nodes, whose cells'
  /// qualities are up to date: transforms the elements around them only, unless they are many.
  MeshQuality transform_around(SmoothingState<dim, spacedim>& state,
                               std::span<const NodeIndex> nodes, double eta);

  /// The sums of some nodes only, ascending, from `cells`, all cells around them, ascending. w_j =
  /// weights[j]; elements with a quality above the threshold count as they are, not transformed.
  void transform_some(const SmoothingState<dim, spacedim>& state, std::span<const NodeIndex> nodes,
                      std::span<const CellIndex> cells, std::span<const double> weights,
                      double threshold);

  /// False where all weights are zero, as those of regular elements are.
  bool has_mean(NodeIndex node) const { return sums(node)[spacedim] > 0.0; }
  /// The weighted mean of a node's positions in its transformed elements.
  Point<spacedim> mean(NodeIndex node) const {
    Point<spacedim> mean;
    for (int d = 0; d < spacedim; ++d) mean[d] = sums(node)[d] / sums(node)[spacedim];
    return mean;
  }

 private:
  struct Tables;  ///< sums by blocks of cells, and which elements add to them
  const double* sums(NodeIndex node) const { return sums_ + 4 * std::size_t{node}; }

  std::unique_ptr<Tables> tables_;
  const double* sums_ = nullptr;  ///< four of each node: weighted coordinates and weight
};

}  // namespace smoothfem
