// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "smoothing/getme/element_parameters.h"
#include "smoothing/loop/smoother.h"

namespace smoothfem {

/// Weighted sums for GETMe's averaging (thesis, Eq. 4.2). Each element E_j is transformed to E'_j.
/// A node gets the sums of w_j p' and of w_j over its elements, where p' is its position in E'_j.
/// One node in scalar code:
///
///   Point sum = zero; double weight = 0;
///   for (E_j : elements of node i) {
///     w = pow(1 - mean_ratio(E_j), eta);
///     T = transform(E_j);  // Section 2.3 (polygons), 3.2 or 3.3 (volume elements)
///     T = keep_centroid_and_size(E_j, T);  // Eq. 3.11
///     T = (1 - rho) * E_j + rho * T;  // Eq. 3.12
///     sum += w * T[i];
///     weight += w;
///   }
///   p_i = weight > 0 ? sum / weight : p_i;  // Eq. 4.2
///
/// This class computes several elements at a time. Results are bitwise identical for every number
/// of threads. In a part of a mesh the sums are those of the movements p' - p, rounded so that they
/// do not depend on the parts.
template <int dim, int spacedim = dim>
class ElementPass {
 public:
  ElementPass();
  ~ElementPass();

  /// Prepares a run; call it first. parameters: how elements are transformed. If the mesh has
  /// targets, elements are transformed where these are regular, and get the targets' sizes.
  void prepare(const Mesh<dim, spacedim>& mesh, const ElementParameters<dim>& parameters);

  /// Prescribes the size of each transformed element, measured by its mean node simplex as in
  /// NeighbourSizes. Applies to elements whose scaling fits the neighbours. of_cells: one positive
  /// size for each element; must outlive its use here.
  void prescribe_sizes(std::span<const double> of_cells);

  /// Transforms all elements, with weights w_j = (1 - q(E_j))^eta. Writes the quality of each to
  /// state.cell_quality. Returns the quality of the mesh.
  MeshQuality transform_all(SmoothingState<dim, spacedim>& state, double eta);

  /// Updates the sums for a mesh that differs from the previous one in these nodes only. The
  /// qualities of their cells must be up to date. Transforms the elements around these nodes only,
  /// unless they are many.
  MeshQuality transform_around(SmoothingState<dim, spacedim>& state,
                               std::span<const NodeIndex> nodes, double eta);

  /// Computes the sums of some nodes only. nodes: ascending; cells: all cells around them,
  /// ascending; w_j = weights[j]. Elements with a quality above the threshold count untransformed.
  void transform_some(const SmoothingState<dim, spacedim>& state, std::span<const NodeIndex> nodes,
                      std::span<const CellIndex> cells, std::span<const double> weights,
                      double threshold);

  /// False if all weights of the node are zero, which happens if its elements are regular.
  bool has_mean(NodeIndex node) const { return sums(node)[spacedim] > 0.0; }
  /// Returns the weighted mean of a node's positions in its transformed elements.
  Point<spacedim> mean(NodeIndex node) const {
    Point<spacedim> mean;
    for (int d = 0; d < spacedim; ++d) mean[d] = sums(node)[d] / sums(node)[spacedim];
    return base_ == nullptr ? mean : base_[node] + mean;
  }

 private:
  struct Tables;  ///< sums by blocks of cells, and the elements that add to them
  const double* sums(NodeIndex node) const { return sums_ + 4 * std::size_t{node}; }

  std::unique_ptr<Tables> tables_;
  const double* sums_ = nullptr;  ///< four for each node: weighted coordinates and weight
  /// In a part of a mesh: the coordinates that the transformed elements are relative to.
  const Point<spacedim>* base_ = nullptr;
};

}  // namespace smoothfem
