// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/solution/tensor_field.h"

namespace smoothfem {

/// Huang's functional of a mesh, least where its cells have one size (equidistribution) and the
/// shape of the reference's cells (alignment) in a metric M, discretized as by Huang and Kamenski
/// (2015, Eqs. 12, 24): I = sum over simplices K of |K| G,
///   G = theta sqrt(det M) tr(J M^-1 J^T)^(d p / 2)
///       + (1 - 2 theta) d^(d p / 2) sqrt(det M) (det J / sqrt(det M))^p,
/// with J the linear map from K to K of the reference, and M taken at K's centroid. It is infinite
/// where a simplex has no positive size, and grows beyond bounds on the way there. Triangles and
/// tetrahedra are simplices; quadrilaterals and hexahedra are the mean over those at their corners.
template <int dim>
class MeshFunctional {
 public:
  /// reference: with valid cells.
  explicit MeshFunctional(const Mesh<dim>& reference);

  /// The metric for all that follows, on the mesh as it is now.
  void set_metric(TensorField<dim> metric);

  /// I of a mesh of the same topology; infinite if it is not valid.
  double value(const Mesh<dim>& mesh);

  /// dI / dx_i of the last value, which has to be finite, for each node i; M follows the simplices.
  const std::vector<Point<dim>>& gradient() const { return gradient_; }

 private:
  using Matrix = Eigen::Matrix<double, dim, dim>;
  struct Simplex {
    std::array<NodeIndex, dim + 1> nodes;
    double share;      ///< of its size that counts: they make up the cell together
    Matrix reference;  ///< its edges there
  };
  struct Term {
    double value = 0.0;
    Matrix by_edges = Matrix::Zero();             ///< derivatives in the edges from node 0
    Point<dim> by_centroid = Point<dim>::Zero();  ///< in the place where M is taken
  };

  static Matrix edges(const Simplex& simplex, std::span<const Point<dim>> x);
  Term term(std::size_t k, std::span<const Point<dim>> x);

  std::vector<Simplex> simplices_;
  std::vector<CellIndex> cells_;  ///< of the metric's mesh, where each was found last
  std::vector<CellIndex> first_cells_;
  std::unique_ptr<const TensorField<dim>> metric_;
  std::vector<Term> terms_;
  std::vector<Point<dim>> gradient_;
};

}  // namespace smoothfem
