// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/solution/tensor_field.h"

namespace smoothfem {

/// Huang's functional of a mesh. It is smallest if cells have one size (equidistribution) and the
/// shape of the reference's cells (alignment) in a metric M. Discretized as by Huang and Kamenski
/// (2015, Eqs. 12, 24):
///
///   I = sum over simplices K of |K| G,
///   G = theta sqrt(det M) tr(J M^-1 J^T)^(d p / 2)
///       + (1 - 2 theta) d^(d p / 2) sqrt(det M) (det J / sqrt(det M))^p.
///
/// J is the linear map from K to K of the reference, and M is taken at K's centroid. I is infinite
/// if a simplex has no positive size, and tends to infinity on the way there. Triangles and
/// tetrahedra are simplices; quadrilaterals and hexahedra are the mean over the simplices at their
/// corners.
template <int dim>
class MeshFunctional {
 public:
  /// reference: a mesh with valid cells.
  explicit MeshFunctional(const Mesh<dim>& reference);

  /// Sets the metric for all later evaluations, on the mesh in its present state.
  void set_metric(TensorField<dim> metric);

  /// Returns I of a mesh of the same topology; infinite if it is not valid.
  double value(const Mesh<dim>& mesh);

  /// Returns dI / dx_i of the last value, which must be finite, for each node i. M moves with the
  /// simplices.
  const std::vector<Point<dim>>& gradient() const { return gradient_; }

 private:
  using Matrix = Eigen::Matrix<double, dim, dim>;
  struct Simplex {
    std::array<NodeIndex, dim + 1> nodes;
    double share;  ///< fraction of its size that counts; the fractions of a cell add up to the cell
    Matrix reference;  ///< its edges in the reference
  };
  struct Term {
    double value = 0.0;
    Matrix by_edges = Matrix::Zero();             ///< derivatives by the edges from node 0
    Point<dim> by_centroid = Point<dim>::Zero();  ///< derivatives by the point where M is taken
  };

  static Matrix edges(const Simplex& simplex, std::span<const Point<dim>> x);
  Term term(std::size_t k, std::span<const Point<dim>> x);

  std::vector<Simplex> simplices_;
  std::vector<CellIndex> cells_;  ///< cells of the metric's mesh, where each was found last
  std::vector<CellIndex> first_cells_;
  std::unique_ptr<const TensorField<dim>> metric_;
  std::vector<Term> terms_;
  std::vector<Point<dim>> gradient_;
};

}  // namespace smoothfem
